// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "palmar/core/progress.h"
#include "palmar/grasp/find/grasp_settings.h"
#include "palmar/workflow/hand/load_hand.h"
#include "palmar/workflow/note/note.h"
#include "palmar/workflow/product/product_choice.h"

namespace palmar::workflow {

/// A hand to be closed on a product, without contact mechanics.
struct GraspRequest {
  ProductChoice product;
  HandChoice hand;
  grasp::GraspSettings grasp;
  std::string grasp_file;  ///< JSON of a grasp that is taken as it is; "": one is searched
  NoteSink note = {};      ///< what was found in the product
  void check() const;      ///< throws UsageError: field, value, what is allowed
};

struct GraspOutcome {
  product::Product product;
  std::shared_ptr<const hand::Hand> hand;
  grasp::Grasp grasp;  ///< the best way of holding, with its runners-up
};

/// Reads product and hand and holds the product: hold_product(), or as the file says. Throws
/// UsageError, InputError naming the file, Cancelled.
GraspOutcome grasp_product(const GraspRequest& request, const Progress& progress = {});

/// The grasp of a file (read_postures()) with one posture. Throws InputError, and UsageError if it
/// doesn't say where the product is.
grasp::Grasp read_grasp(const std::string& file, const hand::Hand& hand,
                        const product::Product& product);

}  // namespace palmar::workflow
