// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "palmar/grasp/grip.h"
#include "palmar/hand/anatomy.h"

namespace palmar {

/// Flexion moment [N mm] that the muscles of a power grip can put on a joint of a finger; 0 for
/// other degrees of freedom. PIP: Li, Zatsiorsky & Latash 2000, Clin Biomech 15:203-211 (lowest
/// values of their table 3, at second hand). MCP and DIP: 1.34 and 0.31 times that, the proportion
/// in which the long flexors turn the joints of a middle finger bent to 45 degrees: FDP 184.5 N and
/// FDS 189 N (cross-sections of Synek et al. 2019, PeerJ 7470) at the moment arms of An et al. 1979
/// (DIP 6.0; PIP 9.9, 8.6; MCP 12.8, 14.8 mm), less those of an extensor that holds against them
/// (EDC 76.5 N: MCP 9.2 mm; three tenths of it at PIP 5.6 and DIP 4.0 mm).
double flexion_strength(Dof dof);

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

}  // namespace palmar
