// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli.h"
#include "grasp/hold_arguments.h"
#include "palmar/contact/contact.h"
#include "palmar/grasp/grasp_settings.h"

namespace palmar::cli {

/// The options by which assess and grasp place and close the hand.
class GraspArguments {
 public:
  std::string hand = "template", unit;

  /// Adds --hand, --grip, --hold, --part, --along, --toward, --up, --purpose, --unit, --at, --axis,
  /// --region, --turn-deg, --fingertip, --place-per-hand and the depths to a verb.
  void add_to(CLI::App& verb);
  GraspSettings settings() const;  ///< throws UsageError naming the option

 private:
  GraspSettings settings_;
  HoldArguments holds_;
  std::string grip_ = "any", at_, axis_, region_;
  std::optional<double> turn_deg_;
  std::vector<std::string> fingertips_;  ///< "FINGER:X,Y,Z"
};

/// The options of the contact solver.
class ContactArguments {
 public:
  std::string preset = "palmar";
  std::string tissue;  ///< file of the hand's tissue, or empty

  /// Adds --preset, --regions, --tissue-model, --kernel, --no-swelling, --shear-modulus-kpa,
  /// --error-band, --refine, --coating and --tissue to a verb.
  void add_to(CLI::App& verb);
  ContactOptions options() const;  ///< throws UsageError naming the option
  ContactModel model() const;      ///< the equations for PreparedHand; throws UsageError

 private:
  std::string kernel_, regions_, tissue_model_;  ///< empty: as in the preset
  bool no_swelling_ = false;
  bool error_band_ = true;
  bool skin_on_skin_ = false;
  bool refine_ = true;
  std::optional<double> shear_modulus_kpa_;
  std::vector<std::string> coatings_;
};

/// "patch" or "point". Throws UsageError naming --kernel.
Kernel parse_kernel(const std::string& text);
/// "halfspace" or "layered". Throws UsageError naming --tissue-model.
TissueModel parse_tissue_model(const std::string& text);
/// THICKNESS_MM,SHEAR_MODULUS_KPA[,POISSON[,X0,Y0,Z0,X1,Y1,Z1]]: two opposite corners of a box.
/// Throws UsageError naming --coating.
Coating parse_coating(const std::string& text);

}  // namespace palmar::cli
