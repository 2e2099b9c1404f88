// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "palmar/contact/contact.h"
#include "palmar/study/assessment.h"

namespace palmar {

/// Pressure limits come in families that differ tenfold and must never be mixed:
///
/// 1. film peak pressure at the onset of pain (75th percentile of 100 adults; ISO/TS 15066:2016,
///    Table A.2), held against the peak pressure of a vertex;
/// 2. pressure at which the skin's blood flow stops (Chalmers thesis 2004, publication 208), for
///    grips held long, held against the peak on sensor cells.
///
/// A third, mean pressure under an algometer (0.1 to 0.2 MPa), is not used: there is no algometer.

/// Pain onset as film peak pressure, MPa: 3.0 finger pad (used for all phalanges), 2.6 palm, 2.0
/// thenar, 2.0 back of the hand.
double pain_onset_film(Region region);

constexpr double kBloodFlowStop = 0.05;  // MPa, sustained

/// The region that comes nearest to its pain onset.
struct NearestToPain {
  Region region{};
  double peak_pressure = 0.0;  ///< MPa
  double limit = 0.0;          ///< MPa, film family
  double share = 0.0;          ///< peak_pressure / limit
};
std::optional<NearestToPain> nearest_to_pain(const ContactResult& contact);

/// Whether the product is held, at least partly, and presses on the skin: only then do its forces
/// and pressures say how it feels to hold it.
bool is_in_hand(const Assessment& assessment);

/// Regions whose peak on sensor cells is above kBloodFlowStop.
int regions_without_blood_flow(const ContactResult& contact);

}  // namespace palmar
