// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cli.h"
#include "palmar/contact/contact.h"
#include "palmar/grasp/find_grasp.h"

namespace palmar::cli {

/// The options by which assess and grasp place and close the hand, as typed.
struct GraspArguments {
  std::string hand = "template", grip = "power", unit, at, axis, region;
  std::optional<double> turn_deg;
  double palm_limit_depth = PowerGraspOptions{}.palm_limit_depth;
  double finger_limit_depth = PowerGraspOptions{}.finger_limit_depth;
  double fingertip_depth = PrecisionGripOptions{}.fingertip_depth;
  std::vector<std::string> fingertips;  ///< "FINGER:X,Y,Z"

  /// Adds --hand, --grip, --unit, --at, --axis, --turn-deg, --fingertip and the depths to a verb.
  void add_to(CLI::App& verb);
  /// The values for the grasp module. Throws UsageError.
  GraspOptions options() const;
  /// The same for a product that may tell by itself which side the thumb is on.
  GraspOptions options_for(const Product& product) const;
};

/// The options of the contact solver, as typed.
struct ContactArguments {
  std::string preset = "palmar";
  std::string kernel, regions, tissue_model;  ///< empty: as in the preset
  bool no_swelling = false;
  std::optional<double> shear_modulus_kpa;
  bool error_band = true;
  std::vector<std::string> coatings;
  std::string tissue;  ///< file of the hand's tissue, or empty

  /// Adds --preset, --regions, --tissue-model, --kernel, --no-swelling, --shear-modulus-kpa,
  /// --error-band, --coating and --tissue to a verb.
  void add_to(CLI::App& verb);
  /// Throws UsageError.
  ContactOptions options() const;
  /// The equations for PreparedHand. Throws UsageError.
  ContactModel model() const;
};

/// "patch" or "point". Throws UsageError naming --kernel.
Kernel parse_kernel(const std::string& text);
/// "halfspace" or "layered". Throws UsageError naming --tissue-model.
TissueModel parse_tissue_model(const std::string& text);
/// THICKNESS_MM,SHEAR_MODULUS_KPA[,POISSON[,X0,Y0,Z0,X1,Y1,Z1]]: two opposite corners of a box.
/// Throws UsageError naming --coating.
Coating parse_coating(const std::string& text);

}  // namespace palmar::cli
