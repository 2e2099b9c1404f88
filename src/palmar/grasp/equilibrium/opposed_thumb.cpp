// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/equilibrium/opposed_thumb.h"

#include <algorithm>
#include <array>
#include <vector>

#include "palmar/grasp/power/finger_cones.h"
#include "palmar/hand/skin/skinning.h"

namespace palmar::grasp {
namespace {

/// Shares of the ranges of CMC flexion and abduction, MP and IP flexion.
constexpr std::array<double, hand::kDigitDofs> kOut{0.05, 0.95, 0.15, 0.12},
    kAcross{0.85, 0.95, 0.7, 0.6};
constexpr double kDepth = 2.5;         // mm, of the thumb's skin in the product: a light touch
constexpr int kParts = 64;             // of the way, in each of which nothing is passed unseen
constexpr int kHalvings = 12;          // of the one in which it meets something
constexpr std::size_t kEverySkin = 3;  // one vertex in so many is looked at

}  // namespace

hand::Posture with_opposed_thumb(const hand::Hand& hand, const product::Product& product,
                                 const GripState& closed) {
  std::vector<int> skin;
  for (std::size_t v = 0; v < hand.segment.size(); v += kEverySkin) {
    const hand::Segment segment = hand.segment[v];
    if (segment == hand::Segment::kThumbProximal || segment == hand::Segment::kThumbDistal) {
      skin.push_back(static_cast<int>(v));
    }
  }
  const FingerCones cones(hand);
  const auto at = [&](double way) {
    hand::Posture posture = closed.posture;
    for (int k = 0; k < hand::kDigitDofs; ++k) {
      const hand::JointDof& dof = hand.skeleton.dof(grip_dof(k));
      const auto i = static_cast<std::size_t>(k);
      const double share = kOut[i] + way * (kAcross[i] - kOut[i]);
      posture[dof.dof] = dof.lower + share * (dof.upper - dof.lower);
    }
    return posture;
  };
  /// How much room is left before the thumb meets something, mm.
  const auto room = [&](double way) {
    const hand::Posture posture = at(way);
    double least = kDepth;
    for (const Vec3& point : hand::pose_skin_vertices(hand, posture, skin)) {
      const double distance = product.distance->at(closed.product_from_hand * point).distance;
      least = std::min(least, distance + kDepth);
    }
    const std::vector<RoundCone> bones = cones.posed(hand.skeleton, posture);
    for (const RoundCone& a : bones) {
      if (a.finger != hand::Finger::kThumb || a.level == 0) continue;
      for (const RoundCone& b : bones) {
        if (b.finger == hand::Finger::kThumb || b.level == 0) continue;
        least = std::min(least, -overlap(a, b));
      }
    }
    return least;
  };
  double free = 0.0, met = 1.0;
  for (int part = 1; part <= kParts; ++part) {
    const double way = static_cast<double>(part) / kParts;
    if (room(way) < 0.0) {
      met = way;
      break;
    }
    free = way;
  }
  for (int i = 0; i < kHalvings && free < met; ++i) {
    const double middle = 0.5 * (free + met);
    (room(middle) < 0.0 ? met : free) = middle;
  }
  return at(free);
}

}  // namespace palmar::grasp
