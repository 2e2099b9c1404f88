// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "palmar/contact/contact.h"
#include "palmar/grasp/pressure_thresholds.h"
#include "palmar/study/assessment/assessment.h"

namespace palmar {

/// What the report says of them; the limits and their families: pressure_thresholds.h. It holds the
/// film family against the peak pressure of a vertex, on the safe side of the cells that comfort.h
/// takes.

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
