// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::cad {

/// A groove whose section is an arc of a circle, along a line on the surface: where a finger lies.
/// Along the line given as points, or around the model's longest axis.
struct GrooveEdit {
  /// mm; near the surface, in order; a B-spline is fitted through what they show (see `smoothing`).
  std::vector<Vec3> points{};
  bool is_closed = false;  ///< the line runs back to its first point
  /// mm along the longest direction from the middle of the model's box: a ring there, no `points`.
  std::optional<double> ring_at{};
  double radius = 8.0;  ///< mm; of the section: the cutter's. A little finger's half width and up
  double depth = 1.0;   ///< mm; of the groove's bottom below the surface
  double rim = 0.0;     ///< mm; radius of the fillet along its rims, 0: left sharp
  double smoothing = 0.5;     ///< mm; the line may pass the points by this
  void check() const;         ///< throws UsageError: field, value, allowed range
  std::string title() const;  ///< "groove of 8 mm radius, 1.5 mm deep"
};

}  // namespace palmar::cad
