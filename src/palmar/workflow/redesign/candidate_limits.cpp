// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/redesign/candidate_limits.h"

#include "palmar/workflow/redesign/redesign_request.h"

namespace palmar::workflow {

void CandidateLimits::check() const {
  if (smallest_volume) {
    require_setting(*smallest_volume > 0.0, "smallest volume", *smallest_volume, "above 0");
  }
  if (largest_volume) {
    require_setting(*largest_volume > 0.0, "largest volume", *largest_volume, "above 0");
  }
  require_setting(lost_hands >= 0.0 && lost_hands <= 1.0, "lost hands", lost_hands, "0 to 1");
}

std::vector<redesign::SearchConstraint> CandidateLimits::on_volume() const {
  std::vector<redesign::SearchConstraint> all;
  if (smallest_volume) all.push_back({"volume by the original's", "", *smallest_volume, false});
  if (largest_volume) all.push_back({"volume by the original's", "", *largest_volume, true});
  return all;
}

std::vector<double> CandidateLimits::volumes(double ratio) const {
  return std::vector<double>(on_volume().size(), ratio);
}

redesign::SearchConstraint CandidateLimits::on_lost_hands() const {
  return {"share of hands that lose hold", "", lost_hands, true};
}

}  // namespace palmar::workflow
