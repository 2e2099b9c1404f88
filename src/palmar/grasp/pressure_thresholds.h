// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "palmar/hand/anatomy.h"

namespace palmar::grasp {

/// Thresholds of pressure come in families that were measured with different instruments and ask
/// different things. Verdicts use one family per question, so that no two of them disagree:
///
/// kProbe      mean pressure under a flat probe of about 1 cm^2, pressed on one place of the hand
/// at a
///             time, at the onset of discomfort and of pain (Johansson et al. 1999): does it hurt
///             in a moment, is it uncomfortable when it is repeated?
/// kBloodFlow  pressure at which the skin's blood flow stops, for grips held for minutes (Chalmers
///             thesis 2004, publication 208);
/// kFilm       peak pressure on a film under a flat probe of 14 x 14 mm at the onset of pain (75th
///             percentile of 100 adults; ISO/TS 15066:2016, Table A.2): for the clamping of people
///             by robots, an expert's figure and no part of the verdicts.
enum class PressureFamily { kProbe, kBloodFlow, kFilm };
std::string_view name_of(PressureFamily family);  ///< "probe", "blood_flow", "film_peak"

/// Pain onset as film peak pressure, MPa: 3.0 finger pad (used for all phalanges), 2.6 palm, 2.0
/// thenar, 2.0 back of the hand.
double pain_onset_film(hand::Region region);

/// Mean pressure under a probe at which pain begins, MPa: 0.496 finger, 0.494 palm, 0.447 thenar
/// (Johansson et al. 1999, Ergonomics 42:1268-1282); the palm's
/// for the back of the hand, where none is known. Only the ratios of discomfort to pain are checked
/// against the paper (its abstract); the absolute values are not: they agree with the 100 to almost
/// 200 kPa for the onset of discomfort in Harih & Tada 2015, and the paper itself was not at hand.
double pain_onset_probe(hand::Region region);

/// The same at which discomfort begins, MPa: 0.188 finger, 0.200 palm, 0.100 thenar. That is 38, 40
/// and 22 % of the onset of pain, as the paper's abstract says.
double discomfort_onset_probe(hand::Region region);

constexpr double kBloodFlowStop = 0.05;  // MPa, sustained

}  // namespace palmar::grasp
