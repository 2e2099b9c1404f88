// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/power/finger_cones.h"

#include <algorithm>
#include <cmath>

#include "palmar/core/enum_index.h"

namespace palmar::grasp {
namespace {

double radius_at(const RoundCone& cone, double t) {
  return (1.0 - t) * cone.radius_a + t * cone.radius_b;
}

// Mean distance of the skin of a part from its line, in the half towards a and that towards b.
void fit_radii(const hand::Hand& hand, const std::vector<char>& belongs, RoundCone& cone) {
  double sum[2] = {0.0, 0.0};
  int count[2] = {0, 0};
  const Vec3 along = cone.b - cone.a;
  for (std::size_t v = 0; v < belongs.size(); ++v) {
    if (belongs[v] == 0) continue;
    const Vec3 r = hand.skin.vertices[v] - cone.a;
    const double t = along.dot(r) / along.squaredNorm();
    if (t < 0.0 || t > 1.0) continue;  // round ends would blur the radius
    const int half = t < 0.5 ? 0 : 1;
    sum[half] += (r - t * along).norm();
    ++count[half];
  }
  const double fallback = 0.25 * along.norm();
  const double near = count[0] > 0 ? sum[0] / count[0] : fallback;
  const double far = count[1] > 0 ? sum[1] / count[1] : near;
  // The halves' means stand at 1/4 and 3/4.
  cone.radius_a = std::max(1.0, near + 0.5 * (near - far));
  cone.radius_b = std::max(1.0, far + 0.5 * (far - near));
}

}  // namespace

ConeDistance distance_from(const RoundCone& cone, const Vec3& point) {
  // min over t in [0, 1] of |point - c(t)| - r(t), which is convex in t: where neither end is
  // nearest, the way to the nearest sphere leans against the line by the slope of the radius.
  const Vec3 along = cone.b - cone.a;
  const double length = along.norm();
  double t = 0.0;
  if (length > 0.0) {
    const Vec3 unit = along / length;
    const double lean = (cone.radius_a - cone.radius_b) / length;
    const double beside = (point - cone.a).cross(unit).norm();
    const double ahead = unit.dot(point - cone.a);
    t = std::abs(lean) < 1.0 ? (ahead - beside * lean / std::sqrt(1.0 - lean * lean)) / length
                             : (lean > 0.0 ? 0.0 : 1.0);
    t = std::clamp(t, 0.0, 1.0);
  }
  const Vec3 out = point - (cone.a + t * along);
  const double from_line = out.norm();
  ConeDistance result;
  result.distance = from_line - radius_at(cone, t);
  if (from_line > 0.0) result.away = out / from_line;
  return result;
}

ConeContact contact_of(const RoundCone& p, const RoundCone& q) {
  // Nearest points of two segments by alternating feet; four rounds reach 0.1 mm for fingers.
  double s = 0.5, t = 0.5;
  for (int round = 0; round < 4; ++round) {
    t = nearest_share(q.a, q.b, p.a + s * (p.b - p.a));
    s = nearest_share(p.a, p.b, q.a + t * (q.b - q.a));
  }
  const Vec3 on_p = p.a + s * (p.b - p.a);
  const Vec3 across = q.a + t * (q.b - q.a) - on_p;
  const double gap = across.norm();
  ConeContact contact;
  contact.overlap = radius_at(p, s) + radius_at(q, t) - gap;
  if (gap > 0.0) contact.normal = across / gap;
  contact.point = on_p + (radius_at(p, s) - 0.5 * contact.overlap) * contact.normal;
  return contact;
}

double overlap(const RoundCone& p, const RoundCone& q) { return contact_of(p, q).overlap; }

FingerCones::FingerCones(const hand::Hand& hand) {
  const hand::Skeleton& skeleton = hand.skeleton;
  for (int f = 0; f < hand::kFingerCount; ++f) {
    const auto finger = static_cast<hand::Finger>(f);
    const auto segments = hand::segments_of(finger);
    const bool is_thumb = finger == hand::Finger::kThumb;
    const Vec3 base = skeleton.joint(hand::joint_of(*segments[0])).centre;

    Part metacarpal;
    metacarpal.cone.finger = finger;
    // A carpus stands between the wrist and the finger metacarpals: start a third of the way up.
    metacarpal.cone.a =
        is_thumb ? skeleton.joint(hand::JointId::kThumbCmc).centre : Vec3(base * 0.33);
    metacarpal.cone.b = base;
    std::vector<char> belongs(hand.skin.vertices.size(), 0);
    const Vec3 along = base - metacarpal.cone.a;
    for (std::size_t v = 0; v < belongs.size(); ++v) {
      if (hand.segment[v] != hand::Segment::kPalm || hand.region[v] == hand::Region::kDorsum)
        continue;
      const Vec3 r = hand.skin.vertices[v] - metacarpal.cone.a;
      const double t = along.dot(r) / along.squaredNorm();
      const Vec3 across = r - t * along;
      // Palmar skin right above the bone, not that of the neighbours.
      belongs[v] = std::abs(across.x()) < 6.0 ? 1 : 0;
    }
    fit_radii(hand, belongs, metacarpal.cone);
    parts_.push_back(metacarpal);

    for (int level = 0; level < 3 && segments[level]; ++level) {
      const hand::Segment segment = *segments[level];
      Part part;
      part.segment = segment;
      part.cone.finger = finger;
      part.cone.level = level + 1;
      part.cone.a = skeleton.joint(hand::joint_of(segment)).centre;
      const bool is_last = level == 2 || !segments[level + 1];
      part.cone.b = is_last ? skeleton.fingertips[f]
                            : skeleton.joint(hand::joint_of(*segments[level + 1])).centre;
      for (std::size_t v = 0; v < belongs.size(); ++v) {
        belongs[v] = hand.segment[v] == segment ? 1 : 0;
      }
      fit_radii(hand, belongs, part.cone);
      if (is_last) {  // the round end stops at the tip
        const Vec3 d = part.cone.b - part.cone.a;
        part.cone.radius_b = std::min(part.cone.radius_b, 0.45 * d.norm());
        part.cone.b -= d.normalized() * part.cone.radius_b;
      }
      parts_.push_back(part);
    }
  }
}

std::vector<RoundCone> FingerCones::posed(const hand::Skeleton& skeleton,
                                          const hand::Posture& posture) const {
  const hand::PosedSkeleton pose = hand::pose_skeleton(skeleton, posture);
  std::vector<RoundCone> cones;
  cones.reserve(parts_.size());
  for (const Part& part : parts_) {
    RoundCone cone = part.cone;
    geometry::Rigid3 moved;
    if (part.segment) {
      moved = pose.segment[index_of(*part.segment)];
    } else if (cone.finger == hand::Finger::kThumb) {
      moved = pose.thumb_metacarpal;
    }
    cone.a = moved * cone.a;
    cone.b = moved * cone.b;
    cones.push_back(cone);
  }
  return cones;
}

}  // namespace palmar::grasp
