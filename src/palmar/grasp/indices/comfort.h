// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "palmar/contact/contact.h"
#include "palmar/grasp/indices/grasp_index.h"
#include "palmar/grasp/pressure_thresholds.h"

namespace palmar::grasp {

/// One region's pressure and the onsets that it is compared with. MPa.
struct RegionComfort {
  hand::Region region{};
  double peak_pressure = 0.0;           ///< on a sensor cell of 24 mm^2
  double pain = 0.0, discomfort = 0.0;  ///< onsets under a probe
  double film_pain = 0.0;               ///< onset as a film's peak, for experts
  double area = 0.0;                    ///< in contact, mm^2
  double sustained_area = 0.0;          ///< of it above kBloodFlowStop, mm^2
};

/// A region's pressure over its onset, for the region where that is largest.
struct WorstRegion {
  hand::Region region{};
  double pressure = 0.0;  ///< MPa, on a sensor cell
  double onset = 0.0;     ///< MPa
  int above = 0;          ///< regions whose pressure is above their onset
  double share() const { return onset > 0.0 ? pressure / onset : 0.0; }
};

/// How near a pressure comes to an onset. From half of it on is near: our choice, for people's
/// onsets differ about twofold.
enum class OnsetLevel { kBelow, kNear, kAbove };
inline constexpr double kNearOnset = 0.5;  ///< of the onset
OnsetLevel level_of(const WorstRegion& worst);
std::string_view name_of(OnsetLevel level);  ///< "below", "near", "above"

/// Pressure on the skin against what people bear. Three questions, one scale each:
///
///     a moment    does it hurt?             peak on sensor cells over pain_onset_probe()
///     repeated    is it uncomfortable?      peak on sensor cells over discomfort_onset_probe()
///     minutes     does blood still flow?    share of the touched skin above kBloodFlowStop
///
/// A sensor cell (24 mm^2) is smaller than the probe (about 1 cm^2), whose mean pressure would be
/// lower, so pain and discomfort are rather overstated.
struct ComfortResult {
  std::vector<RegionComfort> regions;           ///< in contact, ascending
  std::optional<WorstRegion> pain, discomfort;  ///< nothing without contact
  std::optional<WorstRegion> film;              ///< over pain_onset_film(), for experts
  double area = 0.0;                            ///< in contact, mm^2
  double sustained_area = 0.0;                  ///< above kBloodFlowStop, mm^2
  double sustained_share = 0.0;                 ///< of the area, 0 to 1
};

/// Throws UsageError if the contact is that of another hand.
ComfortResult assess_comfort(const hand::Hand& hand, const contact::ContactResult& contact);

/// Rows of the group "comfort".
GraspIndices to_indices(const ComfortResult& result);

}  // namespace palmar::grasp
