// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "palmar/grasp/grip.h"
#include "palmar/hand/anatomy.h"

namespace palmar::grasp {

enum class Sex { kMale, kFemale };

/// Mean grip strength of a dynamometer [N] by age in years: German general population 2006-2014,
/// stature 175-179 cm (men), 165-169 cm (women); Steiber 2016, PLoS ONE 11(10):e0163917. Nothing
/// below 17 or above 90 years.
std::optional<double> grip_strength(Sex sex, double age);
/// Standard deviation [N] among people of that sex, age and stature; same source (mean less its
/// threshold of one deviation).
std::optional<double> grip_strength_sd(Sex sex, double age);

/// Share of the grip strength that a grip reaches: 1 for power grips; pinches after Mathiowetz et
/// al. 1985 (men of 30-34 years): key 117.4, palmar 109.9, tip 78.3 N of 541.8 N grip; tripod and
/// five fingers like the palmar pinch.
double strength_share(Grip grip);

/// Share of the women and men of that age, each sex counted once, whose strength in that grip is
/// `force` [N] or more: normal distributions with grip_strength() and grip_strength_sd(), times
/// strength_share(). 0 where no strength is known.
double share_who_reach(double force, Grip grip, double age);

}  // namespace palmar::grasp
