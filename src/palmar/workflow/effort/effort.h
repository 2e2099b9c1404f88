// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/contact/contact.h"
#include "palmar/core/progress.h"
#include "palmar/effort/effort.h"
#include "palmar/grasp/find/grasp_settings.h"
#include "palmar/grasp/rest/friction_settings.h"
#include "palmar/grasp/rest/rest_settings.h"
#include "palmar/workflow/hand/load_hand.h"
#include "palmar/workflow/note/note.h"
#include "palmar/workflow/product/product_choice.h"

namespace palmar::workflow {

/// What the muscles of fingers and thumb do while they hold a product.
struct EffortRequest {
  ProductChoice product;
  HandChoice hand;
  grasp::GraspSettings grasp;
  std::string grasp_file;  ///< JSON of a grasp that is taken as it is; "": one is searched
  contact::ContactModel model = contact::palmar_model();  ///< the equations of the skin
  contact::ContactOptions contact;                        ///< without the error band
  grasp::FrictionSettings friction;
  grasp::RestSettings rest;  ///< of a grasp that is searched
  effort::EffortOptions effort;
  NoteSink note = {};  ///< what was found in the product
  void check() const;  ///< throws UsageError: field, value, what is allowed
};

/// Assesses the grasp and finds the tendon forces that hold it: assess_effort(). Throws UsageError,
/// InputError naming the file, Cancelled.
effort::EffortResult effort_of_grasp(const EffortRequest& request, const Progress& progress = {});

}  // namespace palmar::workflow
