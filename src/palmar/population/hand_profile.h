// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/hand/hand.h"
#include "palmar/population/hand_sample.h"

namespace palmar::population {

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
  bool operator==(const HandProfile&) const = default;
};

/// The profiles that come with Palmar, "none" first; docs/method/profiles.md says where their
/// figures come from and which are choices.
const std::vector<HandProfile>& built_in_profiles();

/// The built-in profile of that name. Throws UsageError naming the nearest one.
const HandProfile& profile_named(const std::string& name);

/// The hand with its ranges of motion reduced to `range_share`, about the relaxed posture. Every
/// posture that both hands can take looks the same on both: the thumb's limit postures move inwards
/// with its range. Throws UsageError unless 0 < range_share <= 1.
hand::Hand with_range_share(const hand::Hand& hand, double range_share);

/// The person with the profile's size and strength; range, gloves and nails stand in the profile
/// and count where the hand is posed.
HandSample with_profile(const HandSample& sample, const HandProfile& profile);

/// The hand with the profile's range and size. Where the hand is made from a sample, give the
/// sample its size (with_profile()) and the hand its range (with_range_share()) instead.
hand::Hand with_profile(const hand::Hand& hand, const HandProfile& profile);

}  // namespace palmar::population
