// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/dimensions.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "palmar/core/error.h"
#include "palmar/geometry/section.h"

namespace palmar {
namespace {

// The curve round a point of the plane: of all curves the one whose centre lies nearest.
SectionCurve curve_round(const TriangleMesh& skin, const Vec3& point, const Vec3& normal,
                         const std::string& object) {
  const std::vector<SectionCurve> curves = plane_section(skin, point, normal);
  const SectionCurve* nearest = nullptr;
  double best = std::numeric_limits<double>::max();
  for (const SectionCurve& curve : curves) {
    const double d = (curve_centre(curve) - point).norm();
    if (d >= best) continue;
    best = d;
    nearest = &curve;
  }
  if (nearest == nullptr) {
    throw InputError(object + ": its section plane at y = " + std::to_string(point.y()) +
                     " mm misses the skin");
  }
  return *nearest;
}

// Where the line through `point` along `direction` leaves the curve on either side; `across` is
// square to it in the plane of the curve. Coordinates along the line.
struct Chord {
  double lowest = std::numeric_limits<double>::max();
  double highest = std::numeric_limits<double>::lowest();
};
Chord chord(const SectionCurve& curve, const Vec3& point, const Vec3& direction,
            const Vec3& across) {
  Chord result;
  const std::size_t n = curve.point.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 a = curve.point[i] - point, b = curve.point[(i + 1) % n] - point;
    const double ha = across.dot(a), hb = across.dot(b);
    if ((ha < 0.0) == (hb < 0.0)) continue;
    const double s = ha / (ha - hb);
    const double along = direction.dot((1.0 - s) * a + s * b);
    result.lowest = std::min(result.lowest, along);
    result.highest = std::max(result.highest, along);
  }
  return result;
}

// Middle of a crease on the palmar skin: straight palmar of the crease's centre.
Vec3 crease_middle(const TriangleMesh& skin, const CreasePlane& crease, const Vec3& palmar,
                   const std::string& object) {
  const Vec3 across = crease.normal.cross(palmar).normalized();
  const Vec3 outwards = across.cross(crease.normal);
  const SectionCurve curve = curve_round(skin, crease.point, crease.normal, object);
  const Chord c = chord(curve, crease.point, outwards, across);
  if (!(c.highest >= c.lowest)) {
    throw InputError(object + ": the finger's axis leaves the skin at its proximal crease");
  }
  return crease.point + c.highest * outwards;
}

std::string object_of(Segment segment) {
  return "segment \"" + std::string(name_of(segment)) + "\"";
}

double in_palm_plane(const Vec3& a, const Vec3& b) { return (a - b).head<2>().norm(); }

}  // namespace

HandDimensions measure_hand(const TriangleMesh& skin, const Skeleton& skeleton) {
  return measure_hand(skin, skeleton, HandCreases(skin, skeleton));
}

HandDimensions measure_hand(const TriangleMesh& skin, const Skeleton& skeleton,
                            const HandCreases& creases) {
  HandDimensions d;

  const CreasePlane& wrist = creases.wrist();
  const SectionCurve wrist_curve = curve_round(skin, wrist.point, wrist.normal, "wrist crease");
  double lowest = std::numeric_limits<double>::max(), highest = -lowest;
  for (const Vec3& p : wrist_curve.point) {
    lowest = std::min(lowest, p.x());
    highest = std::max(highest, p.x());
  }
  const Vec3 wrist_middle(0.5 * (lowest + highest), wrist.point.y(), wrist.point.z());
  const Vec3& middle_tip = skeleton.fingertips[static_cast<std::size_t>(Finger::kMiddle)];
  d.hand_length = in_palm_plane(middle_tip, wrist_middle);

  const Vec3& head2 = skeleton.joint(JointId::kIndexMcp).centre;
  const Vec3& head3 = skeleton.joint(JointId::kMiddleMcp).centre;
  const Vec3& head5 = skeleton.joint(JointId::kLittleMcp).centre;
  const Vec3 radial = (head2 - head5).normalized();
  const Vec3 palmar = (Vec3::UnitZ() - radial.z() * radial).normalized();
  const Vec3 normal = palmar.cross(radial).normalized();
  const Vec3 between = 0.5 * (head2 + head5);
  const SectionCurve heads = curve_round(skin, between, normal, "metacarpal heads");
  d.hand_circumference = girth(heads.point, normal);
  d.hand_width = extent(heads.point, radial);
  const Chord thickness = chord(heads, head3, palmar, radial);
  d.hand_thickness = std::max(0.0, thickness.highest - thickness.lowest);

  std::array<Vec3, kSegmentCount> palmar_middle;  // of each segment's proximal crease
  for (int f = 0; f < kFingerCount; ++f) {
    const auto finger = static_cast<Finger>(f);
    const auto chain = segments_of(finger);
    // Nodes of the finger's ray: the palmar direction turns at the joints.
    const int first_node = finger == Finger::kThumb ? 2 : 1;
    const int count = chain[2] ? 3 : 2;
    for (int k = 0; k < count; ++k) {
      const Segment segment = *chain[static_cast<std::size_t>(k)];
      palmar_middle[static_cast<std::size_t>(segment)] =
          crease_middle(skin, creases.proximal_crease(segment),
                        creases.palmar_direction(finger, first_node + k), object_of(segment));
    }
    for (int k = 0; k < count; ++k) {
      const Segment segment = *chain[static_cast<std::size_t>(k)];
      const Vec3& from = creases.proximal_crease(segment).point;
      const Vec3& tip = skeleton.fingertips[static_cast<std::size_t>(f)];
      Vec3 to = tip, to_middle = tip;
      if (k + 1 < count) {
        const Segment next = *chain[static_cast<std::size_t>(k + 1)];
        to = creases.proximal_crease(next).point;
        to_middle = palmar_middle[static_cast<std::size_t>(next)];
      }
      const Vec3 along = (to - from).normalized();
      const Vec3 mean_palmar = creases.palmar_direction(finger, first_node + k) +
                               creases.palmar_direction(finger, first_node + k + 1);
      const Vec3 across = along.cross(mean_palmar).normalized();
      const SectionCurve middle = curve_round(skin, 0.5 * (from + to), along, object_of(segment));
      d.segment[static_cast<std::size_t>(segment)] = {
          .length = along.dot(to_middle - palmar_middle[static_cast<std::size_t>(segment)]),
          .width = extent(middle.point, across),
          .thickness = extent(middle.point, across.cross(along))};
    }
  }
  const Vec3& base = palmar_middle[static_cast<std::size_t>(Segment::kMiddleProximal)];
  d.segment[static_cast<std::size_t>(Segment::kPalm)] = {
      .length = base.y() - wrist.point.y(), .width = d.hand_width, .thickness = d.hand_thickness};
  return d;
}

HandDimensions measure_hand(const Hand& hand) { return measure_hand(hand.skin, hand.skeleton); }

}  // namespace palmar
