// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/dimensions/dimensions.h"

#include <algorithm>

#include "palmar/core/enum_index.h"
#include "palmar/hand/dimensions/hand_sections.h"

namespace palmar::hand {
namespace {

double in_palm_plane(const Vec3& a, const Vec3& b) { return (a - b).head<2>().norm(); }

}  // namespace

HandDimensions measure_hand(const geometry::TriangleMesh& skin, const Skeleton& skeleton) {
  return measure_hand(skin, skeleton, HandCreases(skin, skeleton));
}

HandDimensions measure_hand(const geometry::TriangleMesh& skin, const Skeleton& skeleton,
                            const HandCreases& creases) {
  const HandSections sections = hand_sections(skin, skeleton, creases);
  HandDimensions d;
  d.hand_length =
      in_palm_plane(skeleton.fingertips[index_of(Finger::kMiddle)], sections.wrist_middle);
  d.hand_circumference = geometry::girth(sections.heads.point, sections.normal);
  d.hand_width = geometry::extent(sections.heads.point, sections.radial);
  const Chord thickness = chord(sections.heads, skeleton.joint(JointId::kMiddleMcp).centre,
                                sections.palmar, sections.radial);
  d.hand_thickness = std::max(0.0, thickness.highest - thickness.lowest);
  for (int k = 1; k < kSegmentCount; ++k) {
    const SegmentSection& s = sections.segment[k];
    d.segment[k] = {.length = s.along.dot(s.to_palmar - s.from_palmar),
                    .width = geometry::extent(s.middle.point, s.across),
                    .thickness = geometry::extent(s.middle.point, s.palmar)};
  }
  const Vec3& base = sections.segment[index_of(Segment::kMiddleProximal)].from_palmar;
  d.segment[index_of(Segment::kPalm)] = {.length = base.y() - creases.wrist().point.y(),
                                         .width = d.hand_width,
                                         .thickness = d.hand_thickness};
  return d;
}

HandDimensions measure_hand(const Hand& hand) { return measure_hand(hand.skin, hand.skeleton); }

}  // namespace palmar::hand
