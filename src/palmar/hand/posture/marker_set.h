// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/hand/skin/hand_points.h"

namespace palmar::hand {

/// Where the markers of a recording sit on a hand.
struct MarkerSet {
  std::string name;
  std::vector<std::string> label;  ///< as in the recording
  std::vector<HandPoint> point;    ///< as many
};

/// A marker of the set that comes with Palmar: its label is the name of its landmark.
struct DorsalMarker {
  const char* label;
  const char* purpose;
};

/// 25 markers on the back of a hand over joints, bases and nails, from landmarks.h; together they
/// show all 23 angles. docs/using/postures.md shows where they sit.
const std::vector<DorsalMarker>& dorsal_markers();

/// That set on a hand; markers' centres stand `height` [mm] above the skin. Throws as Landmarks.
MarkerSet dorsal_marker_set(const Hand& hand, double height = 0.0);

}  // namespace palmar::hand
