// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "palmar/contact/contact.h"
#include "palmar/core/progress.h"
#include "palmar/geometry/rigid3.h"
#include "palmar/grasp/rest/friction_settings.h"
#include "palmar/study/assessment/assessment.h"
#include "palmar/workflow/grasp/contact_with_band.h"
#include "palmar/workflow/hand/load_hand.h"
#include "palmar/workflow/note/note.h"
#include "palmar/workflow/product/product_choice.h"

namespace palmar::workflow {

/// A posture and a placement that are taken as they are: measured, or found before.
struct EvaluateRequest {
  ProductChoice product;
  HandChoice hand;
  std::string posture_file;  ///< joint angles, JSON or CSV (docs/using/postures.md)
  std::optional<int> frame;  ///< which posture of a file with several, from 1
  /// Where the hand holds the product; over what the file says. At most one of the two.
  std::optional<geometry::Rigid3> product_from_hand = std::nullopt;
  /// The product in the frame of the recording (or mesh) that the posture was found from.
  std::optional<geometry::Rigid3> measured_from_product = std::nullopt;
  contact::ContactModel model = contact::palmar_model();  ///< the equations of the skin
  contact::ContactOptions contact = refined_contact_with_band();
  grasp::FrictionSettings friction;
  std::string natural_postures;  ///< CSV, basis of the index of ease; "": the built-in one
  std::string out;               ///< folder of the report; "": none is written
  bool pictures = true;          ///< PNG pictures in it
  std::uint64_t seed = 0;        ///< written into the results
  std::string command_line;      ///< for provenance
  NoteSink note = {};            ///< what was found in product and posture
  void check() const;            ///< throws UsageError: setting, value, what is allowed
};

struct EvaluateOutcome {
  study::AssessmentSet set;   ///< one product
  bool has_converged = true;  ///< the contact
};

/// Contact, friction and indices of that grasp, without any search. Throws UsageError, InputError
/// naming the file, OutputError, Cancelled.
EvaluateOutcome evaluate_grasp(const EvaluateRequest& request, const Progress& progress = {});

}  // namespace palmar::workflow
