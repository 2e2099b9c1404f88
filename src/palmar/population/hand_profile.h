// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/hand/hand.h"

namespace palmar {

/// What a person's hands can do less, or carry more, than those of the population: factors on any
/// population.
struct HandProfile {
  std::string name = "none";     ///< "none", "reduced_range", "reduced_strength", "gloves" ...
  double range_share = 1.0;      ///< of every joint's range of motion, about the relaxed posture
  double strength_share = 1.0;   ///< of the grip strength and of the muscles' moments
  double glove_thickness = 0.0;  ///< mm
  double glove_shear_modulus = 0.3;  ///< MPa
  double nail_length = 0.0;          ///< beyond the fingertip, mm
  double size_factor = 1.0;          ///< of every length: children
  std::string source;                ///< where the figures come from
  void check() const;                ///< throws UsageError: field, value, allowed range
};

/// The profiles that come with Palmar, "none" first.
const std::vector<HandProfile>& built_in_profiles();

/// The hand with its ranges of motion reduced to `range_share`, about the relaxed posture.
Hand with_range_share(const Hand& hand, double range_share);

}  // namespace palmar
