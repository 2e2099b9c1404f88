// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/skin/drawn_creases.h"

namespace palmar::hand {

HandCreases creases_of(const geometry::TriangleMesh& skin, const Skeleton& skeleton,
                       const DrawnCreases& seen) {
  HandCreases creases(skin, skeleton);
  for (const auto& [segment, plane] : seen) {
    if (segment == Segment::kPalm) {
      creases.set_wrist(plane);
    } else {
      creases.set_proximal_crease(segment, plane);
    }
  }
  return creases;
}

DrawnCreases mirrored(DrawnCreases creases) {
  for (auto& [segment, plane] : creases) {
    plane.point.x() = -plane.point.x();
    plane.normal.x() = -plane.normal.x();
  }
  return creases;
}

}  // namespace palmar::hand
