// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/dimensions/hand_sections.h"

#include <algorithm>
#include <limits>
#include <string>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"

namespace palmar::hand {
namespace {

// The curve round a point of the plane: of all curves the one whose centre lies nearest.
geometry::SectionCurve curve_round(const geometry::TriangleMesh& skin, const Vec3& point,
                                   const Vec3& normal, const std::string& object) {
  const std::vector<geometry::SectionCurve> curves = geometry::plane_section(skin, point, normal);
  const geometry::SectionCurve* nearest = nullptr;
  double best = std::numeric_limits<double>::max();
  for (const geometry::SectionCurve& curve : curves) {
    const double d = (geometry::curve_centre(curve) - point).norm();
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

struct CreaseEnds {
  Vec3 palmar, dorsal;
};

// Middles of a crease on the palmar and the dorsal skin: straight palmar and dorsal of its centre.
CreaseEnds crease_ends(const geometry::TriangleMesh& skin, const CreasePlane& crease,
                       const Vec3& palmar, const std::string& object) {
  const Vec3 across = crease.normal.cross(palmar).normalized();
  const Vec3 outwards = across.cross(crease.normal);
  const geometry::SectionCurve curve = curve_round(skin, crease.point, crease.normal, object);
  const Chord c = chord(curve, crease.point, outwards, across);
  if (!(c.highest >= c.lowest)) {
    throw InputError(object + ": the finger's axis leaves the skin at its proximal crease");
  }
  return {crease.point + c.highest * outwards, crease.point + c.lowest * outwards};
}

std::string object_of(Segment segment) {
  return "segment \"" + std::string(name_of(segment)) + "\"";
}

void section_wrist(const geometry::TriangleMesh& skin, const HandCreases& creases,
                   HandSections& sections) {
  const CreasePlane& wrist = creases.wrist();
  const geometry::SectionCurve curve = curve_round(skin, wrist.point, wrist.normal, "wrist crease");
  double lowest = std::numeric_limits<double>::max(), highest = -lowest;
  for (const Vec3& p : curve.point) {
    lowest = std::min(lowest, p.x());
    highest = std::max(highest, p.x());
  }
  sections.wrist_middle = Vec3(0.5 * (lowest + highest), wrist.point.y(), wrist.point.z());
  const Vec3 across = wrist.normal.cross(Vec3::UnitZ()).normalized();
  const Vec3 outwards = across.cross(wrist.normal);
  const Chord c = chord(curve, sections.wrist_middle, outwards, across);
  if (!(c.highest >= c.lowest)) {
    throw InputError("wrist crease: its middle is outside the skin");
  }
  sections.wrist_palmar = sections.wrist_middle + c.highest * outwards;
  sections.wrist_dorsal = sections.wrist_middle + c.lowest * outwards;
}

void section_heads(const geometry::TriangleMesh& skin, const Skeleton& skeleton,
                   HandSections& sections) {
  const Vec3& head2 = skeleton.joint(JointId::kIndexMcp).centre;
  const Vec3& head5 = skeleton.joint(JointId::kLittleMcp).centre;
  sections.radial = (head2 - head5).normalized();
  sections.palmar = (Vec3::UnitZ() - sections.radial.z() * sections.radial).normalized();
  sections.normal = sections.palmar.cross(sections.radial).normalized();
  sections.heads = curve_round(skin, 0.5 * (head2 + head5), sections.normal, "metacarpal heads");
}

void section_finger(const geometry::TriangleMesh& skin, const Skeleton& skeleton,
                    const HandCreases& creases, Finger finger, HandSections& sections) {
  const auto chain = segments_of(finger);
  // Nodes of the finger's ray: the palmar direction turns at the joints.
  const int first_node = finger == Finger::kThumb ? 2 : 1;
  const int count = chain[2] ? 3 : 2;
  const auto section = [&](int k) -> SegmentSection& {
    return sections.segment[index_of(*chain[k])];
  };
  for (int k = 0; k < count; ++k) {
    const Segment segment = *chain[k];
    const CreasePlane& crease = creases.proximal_crease(segment);
    const CreaseEnds ends = crease_ends(
        skin, crease, creases.palmar_direction(finger, first_node + k), object_of(segment));
    section(k).from = crease.point;
    section(k).from_palmar = ends.palmar;
    section(k).from_dorsal = ends.dorsal;
  }
  const Vec3& tip = skeleton.fingertips[index_of(finger)];
  for (int k = 0; k < count; ++k) {
    SegmentSection& s = section(k);
    const bool is_last = k + 1 == count;
    s.to = is_last ? tip : section(k + 1).from;
    s.to_palmar = is_last ? tip : section(k + 1).from_palmar;
    s.to_dorsal = is_last ? tip : section(k + 1).from_dorsal;
    s.along = (s.to - s.from).normalized();
    const Vec3 mean_palmar = creases.palmar_direction(finger, first_node + k) +
                             creases.palmar_direction(finger, first_node + k + 1);
    s.across = s.along.cross(mean_palmar).normalized();
    s.palmar = s.across.cross(s.along);
    s.middle = curve_round(skin, 0.5 * (s.from + s.to), s.along, object_of(*chain[k]));
  }
}

}  // namespace

Chord chord(const geometry::SectionCurve& curve, const Vec3& point, const Vec3& direction,
            const Vec3& across) {
  Chord result{std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest()};
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

HandSections hand_sections(const geometry::TriangleMesh& skin, const Skeleton& skeleton,
                           const HandCreases& creases) {
  HandSections sections;
  section_wrist(skin, creases, sections);
  section_heads(skin, skeleton, sections);
  for (int f = 0; f < kFingerCount; ++f) {
    section_finger(skin, skeleton, creases, static_cast<Finger>(f), sections);
  }
  return sections;
}

}  // namespace palmar::hand
