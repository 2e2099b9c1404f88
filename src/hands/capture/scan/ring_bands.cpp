// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/scan/ring_bands.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace palmar::capture {
namespace {

/// Axis of a phalanx, from its joint to the next one or the tip.
struct Axis {
  hand::Segment segment{};
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();
};

std::vector<Axis> axes_of(const hand::Skeleton& skeleton) {
  std::vector<Axis> axes;
  for (int f = 0; f < hand::kFingerCount; ++f) {
    const auto chain = hand::segments_of(static_cast<hand::Finger>(f));
    for (std::size_t k = 0; k < chain.size() && chain[k]; ++k) {
      const bool is_last = k + 1 == chain.size() || !chain[k + 1];
      axes.push_back({*chain[k], skeleton.joint(hand::joint_of(*chain[k])).centre,
                      is_last ? skeleton.fingertips[f]
                              : skeleton.joint(hand::joint_of(*chain[k + 1])).centre});
    }
  }
  return axes;
}

std::optional<RingBand> ring_of(const std::vector<Vec3>& points, const std::vector<Axis>& axes) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : points) middle += p / static_cast<double>(points.size());
  const Axis* nearest = nullptr;
  double least = std::numeric_limits<double>::max();
  for (const Axis& axis : axes) {
    const Vec3 way = axis.to - axis.from;
    if (!(way.squaredNorm() > 0.0)) continue;
    const double s = std::clamp(way.dot(middle - axis.from) / way.squaredNorm(), 0.0, 1.0);
    const double d = (middle - axis.from - s * way).norm();
    if (d >= least) continue;
    least = d;
    nearest = &axis;
  }
  // A ring's middle lies in the finger.
  constexpr double kInside = 6.0, kFarthest = 16.0;  // mm
  if (nearest == nullptr || least > kInside) return {};
  const Vec3 along = (nearest->to - nearest->from).normalized();
  const Vec3 a = along.unitOrthogonal(), b = along.cross(a);
  constexpr int kBins = 24;
  std::array<bool, kBins> is_covered{};
  std::vector<double> places;
  for (const Vec3& p : points) {
    const Vec3 r = p - middle;
    if ((r - along.dot(r) * along).norm() > kFarthest) return {};
    const double turn = std::atan2(b.dot(r), a.dot(r)) / (2.0 * std::numbers::pi) + 0.5;
    is_covered[std::min(kBins - 1, static_cast<int>(turn * kBins))] = true;
    places.push_back(along.dot(r));
  }
  if (std::count(is_covered.begin(), is_covered.end(), true) < kBins * 5 / 6) return {};
  std::sort(places.begin(), places.end());
  RingBand ring;
  ring.segment = nearest->segment;
  ring.width = places[places.size() * 19 / 20] - places[places.size() / 20];
  return ring;
}

}  // namespace

std::vector<RingBand> find_rings(const geometry::TriangleMesh& scan, const SkinMarks& marks,
                                 const geometry::Rigid3& hand_from_scan,
                                 const hand::Skeleton& skeleton) {
  constexpr double kNarrowest = 1.2, kWidest = 15.0;  // mm
  const std::vector<Axis> axes = axes_of(skeleton);
  std::vector<RingBand> rings;
  for (const std::vector<int>& patch : marks.other_colour) {
    std::vector<Vec3> points;
    for (const int v : patch) points.push_back(hand_from_scan * scan.vertices[v]);
    auto ring = ring_of(points, axes);
    if (!ring || ring->width < kNarrowest || ring->width > kWidest) continue;
    ring->vertex = patch;
    rings.push_back(std::move(*ring));
  }
  return rings;
}

geometry::TriangleMesh without_rings(const geometry::TriangleMesh& scan,
                                     const std::vector<RingBand>& rings, double margin) {
  std::vector<char> is_ring(scan.vertices.size(), 0);
  for (const RingBand& ring : rings) {
    Eigen::AlignedBox3d box;
    for (const int v : ring.vertex) box.extend(scan.vertices[v]);
    box.extend(Vec3(box.max() + Vec3::Constant(margin)));
    box.extend(Vec3(box.min() - Vec3::Constant(margin)));
    for (std::size_t v = 0; v < is_ring.size(); ++v) {
      const Vec3& p = scan.vertices[v];
      if (is_ring[v] || !box.contains(p)) continue;
      is_ring[v] = std::any_of(ring.vertex.begin(), ring.vertex.end(), [&](int r) {
        return (scan.vertices[r] - p).squaredNorm() <= margin * margin;
      });
    }
  }
  geometry::TriangleMesh rest{scan.vertices, {}};
  for (const Triangle& t : scan.triangles) {
    if (!is_ring[t[0]] && !is_ring[t[1]] && !is_ring[t[2]]) rest.triangles.push_back(t);
  }
  return rest;
}

}  // namespace palmar::capture
