// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "hands/phantom/person/person_dispersion.h"
#include "palmar/hand/dimensions/hand_dimension.h"
#include "palmar/hand/hand.h"
#include "palmar/population/survey_figures.h"

namespace palmar::phantom {

struct PersonSize {
  grasp::Sex sex = grasp::Sex::kMale;
  double length = 0.0, girth = 0.0;  ///< of the hand, mm
};
/// Women and men alike often; hand length and circumference of ANSUR II (Gordon et al. 2014).
PersonSize drawn_size(std::uint64_t seed, const PersonDispersion& dispersion);

/// Lengths of palm and phalanges of a free person, mm. See sized_hand().
std::vector<hand::SizedDimension> surveyed_lengths(const hand::HandDimensions& base,
                                                   const PersonSize& size, std::uint64_t seed);

/// The start hand in a person's size and proportions, in its own posture.
///
/// A near relative has the start hand's proportions but for 1.5 % in the palm's length and 3 % in
/// every phalanx'.
///
/// A free person (`is_free`) has those of surveys, at face value, as lengths between palmar
/// creases:
///   palm                    ANSUR II: regression of palm length on hand length, its residual
///   middle, distal segments Greiner 1991, in proportion to hand length, scatter at given length
///   fingers                 index, ring and little 0.91, 0.93 and 0.76 of the middle one within 3
///   %
///                           (our choice); the proximal segment is what the others leave. Palm
///                           and fingers are drawn again until all segments lie within 0.7 to 1.4,
///                           0.85 to 1.15 and 0.9 to 1.12 of their means: Greiner's scatter has
///                           errors of measurement in it, and joints would lie out of proportion to
///                           creases
///   thumb, distal           Greiner 1991; proximal: the start hand's within 8.5 %
/// Widths and thicknesses follow in surveyed_widenings().
hand::Hand sized_hand(const hand::Hand& base, std::uint64_t seed,
                      const PersonDispersion& dispersion);

/// By how much a free person's fingers are broader than those of `hand` (sized_hand()), so that
/// index and middle finger have the survey's breadth at their PIP joints over circumference
/// (Greiner 1991); half of the scatter's variance is common to all fingers.
std::array<double, hand::kFingerCount> surveyed_widenings(const hand::Hand& hand,
                                                          std::uint64_t seed,
                                                          const PersonDispersion& dispersion);

/// Breadth of a finger at a joint along its axis, mm: of the section across `along` whose middle is
/// nearest.
double finger_breadth(const geometry::TriangleMesh& skin, const Vec3& joint, const Vec3& axis,
                      const Vec3& along);

}  // namespace palmar::phantom
