// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/precision/fingertip_point.h"

#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/geometry/degrees.h"

namespace palmar::grasp {
namespace {

constexpr double kPadShare = 0.55;
constexpr double kTipShare = 0.72, kTipTilt = 50.0 * geometry::kDegree;
constexpr double kSideShare = 0.65, kSideTilt = 20.0 * geometry::kDegree;
constexpr double kTipSideShare = 0.4, kTipSideTilt = 30.0 * geometry::kDegree;
constexpr double kWebShare = 0.25, kWebTilt = -20.0 * geometry::kDegree, kWebStep = 0.05;
constexpr double kNormalRadius = 4.0;  // mm; the skin's normal is a mean over that much pulp

struct SkinHit {
  std::size_t triangle = 0;
  double distance = 0.0;
  Vec3 weight = Vec3::Zero();
};

// Moeller and Trumbore 1997; only skin of one finger, the farthest hit: the outside.
std::optional<SkinHit> outermost_hit(const hand::Hand& hand, hand::Finger finger,
                                     const Vec3& origin, const Vec3& direction) {
  std::optional<SkinHit> best;
  for (std::size_t t = 0; t < hand.skin.triangles.size(); ++t) {
    const Triangle& corner = hand.skin.triangles[t];
    bool belongs = false;
    for (const int v : corner) {
      belongs = belongs || hand::finger_of(hand.segment[v]) == finger;
    }
    if (!belongs) continue;
    const Vec3& a = hand.skin.vertices[corner[0]];
    const Vec3 ab = hand.skin.vertices[corner[1]] - a;
    const Vec3 ac = hand.skin.vertices[corner[2]] - a;
    const Vec3 p = direction.cross(ac);
    const double det = ab.dot(p);
    if (std::abs(det) < 1e-12) continue;
    const Vec3 s = origin - a;
    const double u = s.dot(p) / det;
    const Vec3 q = s.cross(ab);
    const double v = direction.dot(q) / det;
    if (u < 0.0 || v < 0.0 || u + v > 1.0) continue;
    const double distance = ac.dot(q) / det;
    if (distance <= 0.0 || (best && distance <= best->distance)) continue;
    best = SkinHit{t, distance, Vec3(1.0 - u - v, u, v)};
  }
  return best;
}

Vec3 mean_normal(const hand::Hand& hand, const Vec3& point, const Vec3& outwards) {
  Vec3 sum = Vec3::Zero();
  for (const Triangle& t : hand.skin.triangles) {
    const Vec3& a = hand.skin.vertices[t[0]];
    const Vec3& b = hand.skin.vertices[t[1]];
    const Vec3& c = hand.skin.vertices[t[2]];
    const double r = ((a + b + c) / 3.0 - point).norm();
    if (r >= kNormalRadius) continue;
    const Vec3 normal = (b - a).cross(c - a);
    if (normal.dot(outwards) > 0.0) sum += (1.0 - r / kNormalRadius) * normal;
  }
  return sum.norm() > 0.0 ? Vec3(sum.normalized()) : outwards;
}

}  // namespace

std::string_view name_of(FingertipPart part) {
  switch (part) {
    case FingertipPart::kPad:
      return "pad";
    case FingertipPart::kTip:
      return "tip";
    case FingertipPart::kRadialSide:
      return "radial_side";
    case FingertipPart::kTipSide:
      return "tip_side";
    case FingertipPart::kWeb:
      return "web";
    case FingertipPart::kMiddlePad:
      return "middle_pad";
  }
  return "unknown";
}

FingertipPoint fingertip_point(const hand::Hand& hand, hand::Finger finger, FingertipPart part) {
  const hand::Skeleton& skeleton = hand.skeleton;
  const auto segments = hand::segments_of(finger);
  const bool is_side = part == FingertipPart::kRadialSide || part == FingertipPart::kTipSide ||
                       part == FingertipPart::kWeb;
  if (is_side && finger == hand::Finger::kThumb) {
    throw Error("fingertip point: the thumb has no radial side that grips use");
  }
  if (part == FingertipPart::kMiddlePad && finger == hand::Finger::kThumb) {
    throw Error("fingertip point: the thumb has no middle phalanx");
  }
  const std::size_t last = finger == hand::Finger::kThumb ? 1 : 2;
  const bool is_on_middle = part == FingertipPart::kRadialSide || part == FingertipPart::kMiddlePad;
  const std::size_t level = part == FingertipPart::kWeb ? 0 : is_on_middle ? 1 : last;
  const hand::Segment segment = *segments[level];
  const hand::JointDof& flexion = skeleton.joint(hand::joint_of(segment)).dofs.back();
  const Vec3 from = skeleton.joint(hand::joint_of(segment)).centre;
  const Vec3 to = level < last ? skeleton.joint(hand::joint_of(*segments[level + 1])).centre
                               : skeleton.fingertips[index_of(finger)];
  const Vec3 along = (to - from).normalized();
  const Vec3 palmar = flexion.axis.cross(along).normalized();
  Vec3 radial = along.cross(palmar);
  const Vec3 towards_thumb = skeleton.joint(hand::JointId::kIndexMcp).centre -
                             skeleton.joint(hand::JointId::kLittleMcp).centre;
  if (radial.dot(towards_thumb) < 0.0) radial = -radial;

  Vec3 direction = palmar;
  double share = kPadShare;
  if (part == FingertipPart::kTip) {
    share = kTipShare;
    direction = std::cos(kTipTilt) * palmar + std::sin(kTipTilt) * along;
  } else if (is_side) {
    share = part == FingertipPart::kWeb       ? kWebShare
            : part == FingertipPart::kTipSide ? kTipSideShare
                                              : kSideShare;
    const double tilt = part == FingertipPart::kWeb       ? kWebTilt
                        : part == FingertipPart::kTipSide ? kTipSideTilt
                                                          : kSideTilt;
    direction = std::cos(tilt) * radial + std::sin(tilt) * palmar;
  }
  Vec3 origin = from + share * (to - from);
  std::optional<SkinHit> hit = outermost_hit(hand, finger, origin, direction);
  // Where the skin of a finger's root begins differs from hand to hand.
  for (double farther = kWebStep; part == FingertipPart::kWeb && !hit && farther < 0.5;
       farther += kWebStep) {
    origin = from + (share + farther) * (to - from);
    hit = outermost_hit(hand, finger, origin, direction);
  }
  if (!hit) {
    throw Error("fingertip point: no skin of " + std::string(name_of(segment)) +
                " is on the side of its " + std::string(name_of(part)));
  }
  FingertipPoint result;
  result.finger = finger;
  result.segment = segment;
  result.part = part;
  result.point = origin + hit->distance * direction;
  result.normal = mean_normal(hand, result.point, direction);
  result.triangle = hand.skin.triangles[hit->triangle];
  result.weight = hit->weight;
  return result;
}

}  // namespace palmar::grasp
