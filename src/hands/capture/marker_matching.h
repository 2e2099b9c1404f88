// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::capture {

/// Pairs points one to one so that the sum of squared distances is least, where leaving a point
/// alone costs gate^2. Returns for each expected point the index of the one found there.
std::vector<std::optional<int>> assign_points(const std::vector<Vec3>& expected,
                                              const std::vector<Vec3>& found, double gate);

struct MarkerMatchOptions {
  double gate = 16.0;           ///< farthest from where a marker is expected at first, mm
  double last_gate = 6.0;       ///< when neighbours' errors are known, mm
  double neighbourhood = 18.0;  ///< over which those are alike, mm
  void check() const;           ///< throws UsageError: field, value, allowed range
};

/// Finds markers again, of which some are missing and some found are none. A first assignment with
/// a wide gate; then each marker is expected where the errors of its neighbours say (weights
/// exp(-r^2/(2 h^2)), itself left out), and the gate narrows over three rounds.
std::vector<std::optional<int>> match_markers(const std::vector<Vec3>& expected,
                                              const std::vector<Vec3>& found,
                                              const MarkerMatchOptions& options = {});

}  // namespace palmar::capture
