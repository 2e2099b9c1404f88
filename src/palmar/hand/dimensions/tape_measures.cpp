// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/dimensions/tape_measures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "palmar/core/enum_index.h"
#include "palmar/hand/dimensions/hand_sections.h"

namespace palmar::hand {
namespace {

using Vec2 = Eigen::Vector2d;

/// A point of a curve: on the piece that begins at corner `index`.
struct OnCurve {
  std::size_t index = 0;
  Vec3 point = Vec3::Zero();
  double distance = std::numeric_limits<double>::max();  ///< from what it was looked for
};

OnCurve nearest_on(const geometry::SectionCurve& curve, const Vec3& to) {
  OnCurve best;
  const std::size_t n = curve.point.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3& p = curve.point[i];
    const Vec3 piece = curve.point[(i + 1) % n] - p;
    const double squared = piece.squaredNorm();
    const double s = squared > 0.0 ? std::clamp(piece.dot(to - p) / squared, 0.0, 1.0) : 0.0;
    const Vec3 q = p + s * piece;
    const double d = (q - to).norm();
    if (d < best.distance) best = {i, q, d};
  }
  return best;
}

/// Corners from one point of a closed curve to another in the curve's own direction.
std::vector<Vec3> part_between(const geometry::SectionCurve& curve, const OnCurve& from,
                               const OnCurve& to) {
  std::vector<Vec3> part{from.point};
  const std::size_t n = curve.point.size();
  const bool is_behind = from.index == to.index && (from.point - curve.point[from.index]).norm() <=
                                                       (to.point - curve.point[from.index]).norm();
  if (!is_behind) {
    std::size_t i = from.index;
    do {
      i = (i + 1) % n;
      part.push_back(curve.point[i]);
    } while (i != to.index);
  }
  part.push_back(to.point);
  return part;
}

/// Twice the area between a part and the line through its ends, positive on the side of `over`.
double area_over(const std::vector<Vec3>& part, const Vec3& along, const Vec3& over) {
  double area = 0.0;
  for (std::size_t i = 0; i + 1 < part.size(); ++i) {
    const Vec3 p = part[i] - part.front(), q = part[i + 1] - part.front();
    area += (over.dot(p) + over.dot(q)) * along.dot(q - p);
  }
  return area;
}

double upper_hull_length(const std::vector<Vec3>& part, const Vec3& along, const Vec3& over) {
  const double length = along.dot(part.back() - part.front());
  std::vector<Vec2> flat;
  for (const Vec3& p : part) {
    const double x = along.dot(p - part.front());
    if (x >= 0.0 && x <= length) flat.emplace_back(x, over.dot(p - part.front()));
  }
  // The ends are where the tape is held, whatever lies straight above them.
  std::erase_if(flat, [&](const Vec2& p) { return p.x() <= 0.0 || p.x() >= length; });
  flat.emplace_back(0.0, 0.0);
  flat.emplace_back(length, 0.0);
  std::sort(flat.begin(), flat.end(), [](const Vec2& p, const Vec2& q) {
    return p.x() != q.x() ? p.x() < q.x() : p.y() < q.y();
  });
  std::vector<Vec2> hull;  // Andrew 1979
  for (const Vec2& p : flat) {
    while (hull.size() >= 2) {
      const Vec2 u = hull.back() - hull[hull.size() - 2], v = p - hull.back();
      if (u.x() * v.y() - u.y() * v.x() < 0.0) break;
      hull.pop_back();
    }
    hull.push_back(p);
  }
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < hull.size(); ++i) sum += (hull[i + 1] - hull[i]).norm();
  return sum;
}

/// A tape along the skin from a to b, in the plane that holds `over`; nothing if one curve doesn't
/// pass both.
std::optional<double> tape(const geometry::TriangleMesh& skin, const Vec3& a, const Vec3& b,
                           const Vec3& over) {
  const Vec3 normal = (b - a).cross(over).normalized();
  constexpr double kOn = 3.0;  // mm: fingertips may lie a little off a mesh that was smoothed
  double least = kOn;
  std::optional<double> length;
  for (const geometry::SectionCurve& curve : geometry::plane_section(skin, a, normal)) {
    const double off = std::max(nearest_on(curve, a).distance, nearest_on(curve, b).distance);
    if (off >= least) continue;
    least = off;
    length = taut_length(curve, a, b, over);
  }
  return length;
}

std::optional<double> along_middle_finger(const HandTape& tape,
                                          std::optional<double> SegmentTape::*length) {
  double sum = 0.0;
  for (const Segment segment :
       {Segment::kPalm, Segment::kMiddleProximal, Segment::kMiddleMiddle, Segment::kMiddleDistal}) {
    const auto& part = tape.segment[index_of(segment)].*length;
    if (!part) return {};
    sum += *part;
  }
  return sum;
}

/// From the middle of one side of a section to that of the other, over the palmar side and over the
/// dorsal one. (From one outermost point to the other wouldn't do: on a flat side they jump.)
std::array<double, 2> widths(const geometry::SectionCurve& curve, const Vec3& across,
                             const Vec3& palmar) {
  double low = std::numeric_limits<double>::max(), high = -low;
  Vec3 middle = geometry::curve_centre(curve);
  for (const Vec3& p : curve.point) {
    low = std::min(low, palmar.dot(p));
    high = std::max(high, palmar.dot(p));
  }
  middle += (0.5 * (low + high) - palmar.dot(middle)) * palmar;
  const Chord c = chord(curve, middle, across, palmar);
  const Vec3 a = middle + c.lowest * across, b = middle + c.highest * across;
  return {taut_length(curve, a, b, palmar), taut_length(curve, a, b, -palmar)};
}

}  // namespace

double taut_length(const geometry::SectionCurve& curve, const Vec3& a, const Vec3& b,
                   const Vec3& over) {
  if (curve.point.size() < 3) return 0.0;
  const OnCurve from = nearest_on(curve, a), to = nearest_on(curve, b);
  const Vec3 chord = to.point - from.point;
  if (!(chord.norm() > 0.0)) return 0.0;
  const Vec3 along = chord.normalized();
  const Vec3 up = (over - over.dot(along) * along).normalized();
  std::vector<Vec3> one = part_between(curve, from, to), other = part_between(curve, to, from);
  std::reverse(other.begin(), other.end());
  const bool is_one = area_over(one, along, up) >= area_over(other, along, up);
  return upper_hull_length(is_one ? one : other, along, up);
}

std::optional<double> HandTape::palmar_hand_length() const {
  return along_middle_finger(*this, &SegmentTape::palmar_length);
}

std::optional<double> HandTape::dorsal_hand_length() const {
  return along_middle_finger(*this, &SegmentTape::dorsal_length);
}

HandTape measure_with_tape(const geometry::TriangleMesh& skin, const Skeleton& skeleton,
                           const HandCreases& creases) {
  const HandSections sections = hand_sections(skin, skeleton, creases);
  HandTape result;
  const Vec3 palmar = Vec3::UnitZ();
  const SegmentSection& base = sections.segment[index_of(Segment::kMiddleProximal)];
  const auto over_heads = widths(sections.heads, sections.radial, sections.palmar);
  result.segment[index_of(Segment::kPalm)] = {
      .girth = geometry::girth(sections.heads.point, sections.normal),
      .palmar_length = tape(skin, sections.wrist_palmar, base.from_palmar, palmar),
      .dorsal_length = tape(skin, sections.wrist_dorsal, base.from_dorsal, -palmar),
      .palmar_width = over_heads[0],
      .dorsal_width = over_heads[1]};
  for (int k = 1; k < kSegmentCount; ++k) {
    const SegmentSection& s = sections.segment[k];
    const auto half_way = widths(s.middle, s.across, s.palmar);
    result.segment[k] = {.girth = geometry::girth(s.middle.point, s.along),
                         .palmar_length = tape(skin, s.from_palmar, s.to_palmar, s.palmar),
                         .dorsal_length = tape(skin, s.from_dorsal, s.to_dorsal, -s.palmar),
                         .palmar_width = half_way[0],
                         .dorsal_width = half_way[1]};
  }
  return result;
}

std::vector<TapeValue> values_of(const HandTape& tape) {
  std::vector<TapeValue> values;
  const auto add = [&](std::string_view quantity, std::optional<Segment> segment,
                       std::optional<double> value) {
    if (value) values.push_back({quantity, segment, *value});
  };
  add("hand_length_palmar", {}, tape.palmar_hand_length());
  add("hand_length_dorsal", {}, tape.dorsal_hand_length());
  for (int k = 0; k < kSegmentCount; ++k) {
    const auto segment = static_cast<Segment>(k);
    const SegmentTape& s = tape.segment[k];
    add("girth", segment, s.girth);
    add("length_palmar", segment, s.palmar_length);
    add("length_dorsal", segment, s.dorsal_length);
    add("width_palmar", segment, s.palmar_width);
    add("width_dorsal", segment, s.dorsal_width);
  }
  return values;
}

}  // namespace palmar::hand
