// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "palmar/hand/hand.h"
#include "palmar/population/person_estimate.h"
#include "palmar/population/population.h"

namespace palmar::capture {

/// What is known of a hand but its length. 0: unknown.
struct RestOfHand {
  std::array<double, 4> finger{};  ///< fingers II to V, base crease to tip, mm
  double finger_sd = 1.0;          ///< of an error that they share, mm
  double width = 0.0;              ///< over the metacarpal heads, mm
  double width_sd = 1.5;
  double circumference = 0.0;  ///< mm
  double circumference_sd = 3.0;
  double by_skin = 0.0;  ///< the length by where the skin's shape lets one expect the wrist's
                         ///< crease, mm
  static RestOfHand of(const hand::HandDimensions& dimensions);
};

/// Standard deviation of the length by the skin's shape without the wrist's line, mm: the root mean
/// square was 2.6 on the four free persons for development (docs/method/scan.md, "no lines"), and
/// so few tell it to a third.
inline constexpr double kLengthBySkinSd = 3.0;

struct ExpectedLength {
  double value = 0.0, sd = 0.0;  ///< mm
  /// 99 of 100 people lie within it: a note about one hand in a hundred that is as it should be.
  double range() const { return 2.576 * sd; }
};

/// The hand length that people of `population` with the rest of this hand have: the mean and
/// deviation of the joint normal distribution given the rest (estimate_person()).
///
/// Fingers II to V count as one length, so that a single crease that was found wrongly weighs a
/// quarter. Their ruler is uncertain: between the template's palm of 55 % of hand length and ANSUR
/// II's of 60 % nobody knows where people's base creases are, so the share that fingers leave is
/// taken as even between both: its mean is in the middle, its deviation their difference / sqrt 12.
///
/// Nothing if nothing of the rest is known, or if some of it is so rare (one in a thousand) that
/// the hand is none of these people's: a child's among adults.
std::optional<ExpectedLength> expected_hand_length(const RestOfHand& rest,
                                                   const population::Population& population);

/// A sentence for the user if `length` (its error's deviation: `length_sd`, mm) isn't within what
/// is expected; empty otherwise. Of 100 hands that were measured well one is named.
std::string length_doubt(double length, double length_sd, const RestOfHand& rest,
                         const population::Population& population);

/// The same of what was measured on a photograph (measures_of()); empty without a hand length.
std::string length_doubt(const std::vector<population::KnownMeasure>& measures,
                         const population::Population& population);

/// The same of a whole hand among ANSUR II's men and women.
std::string length_doubt(const hand::HandDimensions& dimensions, double by_skin = 0.0);

}  // namespace palmar::capture
