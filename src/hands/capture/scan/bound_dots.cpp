// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/scan/bound_dots.h"

namespace palmar::capture {
namespace {

/// `on_skin`: the segment of the skin under the dot.
hand::Segment drawn_segment(const hand::Skeleton& skeleton, const Vec3& dot,
                            hand::Segment on_skin) {
  constexpr double kDistal = 5.0;  // mm from the joint: beyond what the knuckle's skin slides
  constexpr double kAside = 16.0;  // mm off the bone's axis
  if (on_skin != hand::Segment::kPalm) return on_skin;
  double nearest = kAside;
  for (int f = 1; f < hand::kFingerCount; ++f) {
    const auto chain = hand::segments_of(static_cast<hand::Finger>(f));
    const Vec3& from = skeleton.joint(hand::joint_of(*chain[0])).centre;
    const Vec3 along = (skeleton.joint(hand::joint_of(*chain[1])).centre - from).normalized();
    const double way = (dot - from).dot(along);
    const double aside = (dot - from - way * along).norm();
    if (way < kDistal || aside >= nearest) continue;
    nearest = aside;
    on_skin = *chain[0];
  }
  return on_skin;
}

}  // namespace

std::vector<BoundDot> bind_dots(const hand::Hand& hand, const SkinMarks& marks,
                                const geometry::Rigid3& hand_from_scan) {
  std::vector<BoundDot> dots;
  for (const InkDot& dot : marks.dots) {
    BoundDot bound;
    bound.point = hand_from_scan * dot.point;
    bound.on_hand = hand::skin_point_near(hand, bound.point);
    const hand::Segment on_skin = hand.segment[*bound.on_hand.vertex];
    bound.segment = dot.segment ? *dot.segment : drawn_segment(hand.skeleton, bound.point, on_skin);
    bound.slides = on_skin == hand::Segment::kPalm && bound.segment != hand::Segment::kPalm;
    dots.push_back(std::move(bound));
  }
  return dots;
}

}  // namespace palmar::capture
