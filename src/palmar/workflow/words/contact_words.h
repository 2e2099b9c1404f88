// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/contact/contact.h"

namespace palmar::workflow {

/// The equations of the skin by their names; "": as in the preset.
struct ContactModelWords {
  std::string preset = "palmar";  ///< or "xie2014"
  std::string kernel;             ///< "patch" or "point"
  std::string tissue_model;       ///< "halfspace", "layered" or "bone"
  std::string coupling;           ///< "coupled" or "independent"
};

/// Throws UsageError naming setting and name. Where no tissue model is named, tissue on bone gives
/// way to what the rest asks for (with_permitted_tissue()).
contact::ContactModel contact_model(const ContactModelWords& words);

/// "halfspace", "layered" or "bone". Throws UsageError.
contact::TissueModel parse_tissue_model(const std::string& text);

/// THICKNESS_MM,SHEAR_MODULUS_KPA[,POISSON[,X0,Y0,Z0,X1,Y1,Z1]]: two opposite corners of a box.
/// Throws UsageError.
contact::Coating parse_coating(const std::string& text);

}  // namespace palmar::workflow
