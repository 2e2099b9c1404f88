// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli.h"
#include "grasp/hold_arguments.h"
#include "palmar/contact/contact.h"
#include "palmar/grasp/find/grasp_settings.h"
#include "palmar/workflow/words/contact_words.h"

namespace palmar::cli {

/// The options by which assess and grasp place and close the hand.
class GraspArguments {
 public:
  std::string hand = "template", unit;

  /// Adds --hand, --grip, --hold, --part, --along, --toward, --up, --purpose, --unit, --at, --axis,
  /// --region, --turn-deg, --fingertip, --place-per-hand and the depths to a verb.
  void add_to(CLI::App& verb);
  grasp::GraspSettings settings() const;  ///< throws UsageError naming the option

 private:
  grasp::GraspSettings settings_;
  HoldArguments holds_;
  std::string grip_ = "any", at_, axis_, region_;
  std::optional<double> turn_deg_;
  std::vector<std::string> fingertips_;  ///< "FINGER:X,Y,Z"
};

/// The options of the contact solver.
class ContactArguments {
 public:
  std::string tissue;  ///< file of the hand's tissue, or empty

  /// Adds --preset, --regions, --tissue-model, --kernel, --no-swelling, --shear-modulus-kpa,
  /// --error-band, --refine, --coating and --tissue to a verb.
  void add_to(CLI::App& verb);
  contact::ContactOptions options() const;  ///< throws UsageError naming the option
  /// The equations for PreparedHand; throws UsageError.
  contact::ContactModel model() const { return workflow::contact_model(model_); }
  const std::string& preset() const { return model_.preset; }

 private:
  workflow::ContactModelWords model_;
  bool no_swelling_ = false;
  bool error_band_ = true;
  bool skin_on_skin_ = false;
  bool refine_ = true;
  std::optional<double> shear_modulus_kpa_;
  std::vector<std::string> coatings_;
};

}  // namespace palmar::cli
