// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/page/pressure_limits.h"

#include <algorithm>

namespace palmar {

std::optional<NearestToPain> nearest_to_pain(const ContactResult& contact) {
  std::optional<NearestToPain> nearest;
  for (const RegionContact& one : contact.regions) {
    const double limit = pain_onset_film(one.region);
    const double share = one.peak_pressure / limit;
    if (!nearest || share > nearest->share) {
      nearest = NearestToPain{one.region, one.peak_pressure, limit, share};
    }
  }
  return nearest;
}

bool is_in_hand(const Assessment& assessment) {
  const GraspStatus status = assessment.grasp.status;
  return (status == GraspStatus::kHeld || status == GraspStatus::kPartlyHeld) &&
         !assessment.contact.regions.empty();
}

int regions_without_blood_flow(const ContactResult& contact) {
  return static_cast<int>(std::count_if(
      contact.regions.begin(), contact.regions.end(),
      [](const RegionContact& one) { return one.peak_pressure_cells > kBloodFlowStop; }));
}

}  // namespace palmar
