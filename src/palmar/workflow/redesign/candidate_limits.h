// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "palmar/redesign/feature_search.h"

namespace palmar::workflow {

/// What a candidate of any search must keep to.
struct CandidateLimits {
  std::optional<double> smallest_volume, largest_volume;  ///< shares of the original's
  double lost_hands = 0.1;  ///< share of the hands that hold the original
  void check() const;       ///< throws UsageError: setting, value, allowed range

  std::vector<redesign::SearchConstraint> on_volume() const;
  /// A candidate's values by on_volume(); `ratio`: its volume by the original's.
  std::vector<double> volumes(double ratio) const;
  redesign::SearchConstraint on_lost_hands() const;
};

}  // namespace palmar::workflow
