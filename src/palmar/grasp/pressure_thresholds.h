// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "palmar/hand/anatomy.h"

namespace palmar {

/// Thresholds of pressure come in families that differ tenfold and must never be mixed, as they
/// were measured with different instruments and ask different things:
///
/// kFilm       peak pressure on a film under a flat probe of 14 x 14 mm at the onset of pain (75th
///             percentile of 100 adults; ISO/TS 15066:2016, Table A.2);
/// kAlgometer  mean pressure under an algometer of about 1 cm^2 at the onset of pain: 0.1 to nearly
///             0.2 MPa (as quoted by Harih and Tada 2015);
/// kBloodFlow  pressure at which the skin's blood flow stops, for grips held long (Chalmers thesis
///             2004, publication 208).
enum class PressureFamily { kFilm, kAlgometer, kBloodFlow };
std::string_view name_of(PressureFamily family);  ///< "film_peak", "algometer_mean", "blood_flow"

/// Pain onset as film peak pressure, MPa: 3.0 finger pad (used for all phalanges), 2.6 palm, 2.0
/// thenar, 2.0 back of the hand.
double pain_onset_film(Region region);

/// Pain onset as mean pressure under an algometer, MPa: the two ends of what is quoted. No values
/// per region are known here.
inline constexpr double kPainOnsetAlgometerLow = 0.1;
inline constexpr double kPainOnsetAlgometerHigh = 0.2;

/// Pressure at which discomfort begins, over that at which pain begins: 0.38 finger, 0.40 palm,
/// 0.22 thenar (Johansson et al. 1999); the palm's for the back of the hand, where none is known.
double discomfort_over_pain(Region region);

constexpr double kBloodFlowStop = 0.05;  // MPa, sustained

}  // namespace palmar
