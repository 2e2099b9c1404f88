// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/parts/ring_parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "palmar/product/parts/loop_opening.h"
#include "palmar/product/parts/skeleton_rings.h"

namespace palmar::product {
namespace {

constexpr double kThickestRing = 22.5;  // mm of depth: the thickest bar that a hand closes round
constexpr double kEvenRing = 1.6;       // times the usual thickness that counts as a bar; choice
constexpr double kEvenShare = 0.6;  // of the way round that is one; shanks join the rest; choice
constexpr double kOnRing = 0.75;    // of the bar's depth beside its middle; choice
constexpr int kRays = 48;
constexpr double kMostOfRing = 0.5;   // share of it that is one part's; choice
constexpr double kMostOfPart = 0.75;  // of a part that is the ring; choice
constexpr double kSameOpening = 0.3;  // of the disc's diameter between two middles; choice

std::vector<Vec3> in_product(const SolidGrid& grid, const std::vector<Vec3>& line) {
  std::vector<Vec3> result;
  for (const Vec3& p : line) result.push_back(grid.product_from_grid * p);
  return result;
}

// The bar round an opening, from the voxels on the way outwards from its middle: half its usual
// thickness from the opening's edge. Nothing unless it is a bar all round but where it joins
// others.
std::optional<SkeletonRing> ring_round(const SolidGrid& grid, const PartOpening& opening) {
  const Vec3 centre = grid.product_from_grid.to_grid(opening.centre);
  const Eigen::Matrix3d to_grid = grid.product_from_grid.axes.transpose();
  const Vec3 u = to_grid * opening.wide, v = to_grid * Vec3(opening.axis.cross(opening.wide));
  std::vector<double> edge, thickness;
  const double step = 0.5 * grid.spacing;
  for (int k = 0; k < kRays; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / kRays;
    const Vec3 out = std::cos(angle) * u + std::sin(angle) * v;
    double way = 0.0;
    while (way < opening.width && grid.depth_at(centre + way * out) <= 0.0) way += step;
    edge.push_back(way);
    while (way < edge.back() + 3.0 * kThickestRing && grid.depth_at(centre + way * out) > 0.0) {
      way += step;
    }
    thickness.push_back(way - edge.back());
  }
  std::vector<double> sorted = thickness;
  std::sort(sorted.begin(), sorted.end());
  const double usual = sorted[sorted.size() / 2];
  const auto even = std::count_if(thickness.begin(), thickness.end(),
                                  [&](double t) { return t > step && t <= kEvenRing * usual; });
  if (usual > 2.0 * kThickestRing || even < kEvenShare * kRays || sorted.front() < step) return {};
  SkeletonRing ring;
  for (int k = 0; k < kRays; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / kRays;
    ring.point.push_back(centre +
                         (edge[k] + 0.5 * usual) * (std::cos(angle) * u + std::sin(angle) * v));
    ring.radius.push_back(std::max(grid.depth_at(ring.point.back()), 0.5 * grid.spacing));
  }
  return ring;
}

bool is_on(const SkeletonRing& ring, const SolidBall& ball) {
  for (std::size_t k = 0; k < ring.point.size(); ++k) {
    if ((ring.point[k] - ball.centre).norm() < kOnRing * ring.radius[k]) return true;
  }
  return false;
}

// Whether a part has much besides the ring: two rings in one sheet, a ring on a blade.
bool is_part_of(const SkeletonRing& ring, const RoughParts& rough, int part) {
  int on = 0, all = 0;
  for (const SolidBall& ball : rough.balls) {
    if (ball.part != part) continue;
    ++all;
    on += is_on(ring, ball) ? 1 : 0;
  }
  return on < kMostOfPart * all;
}

// Makes the ring a part of its own; its number.
int split_off(const SkeletonRing& ring, int from, RoughParts& rough) {
  const int number = static_cast<int>(rough.parts.size());
  double moved = 0.0, all = 0.0;
  for (SolidBall& ball : rough.balls) {
    if (ball.part != from) continue;
    const double size = ball.radius * ball.radius;
    all += size;
    if (!is_on(ring, ball)) continue;
    moved += size;
    ball.part = number;
  }
  RoughPart part;
  part.volume = all > 0.0 ? rough.parts[from].volume * moved / all : 0.0;
  rough.parts[from].volume -= part.volume;
  rough.parts.push_back(std::move(part));
  rough.joints.push_back({from, number});
  return number;
}

}  // namespace

void complete_rings(const geometry::TriangleMesh& mesh, const SolidGrid& grid,
                    const SkeletonGraph& graph, double finger, RoughParts& rough) {
  const std::vector<SkeletonRing> rings = rings_of(graph);
  if (rings.size() < 2) return;  // the line of a single ring is whole
  std::vector<PartOpening> known;
  for (const RoughPart& part : rough.parts) {
    if (!part.is_ring && !part.is_in_loop) continue;
    const auto opening = loop_opening(mesh, in_product(grid, part.line));
    if (opening && opening->disc >= finger) known.push_back(*opening);
  }
  for (const SkeletonRing& way : rings) {
    const auto opening = loop_opening(mesh, in_product(grid, way.point));
    if (!opening || opening->disc < finger) continue;
    const bool is_known = std::any_of(known.begin(), known.end(), [&](const PartOpening& other) {
      return (other.centre - opening->centre).norm() < kSameOpening * opening->disc;
    });
    if (is_known) continue;
    const std::optional<SkeletonRing> ring = ring_round(grid, *opening);
    if (!ring) continue;
    std::vector<std::size_t> points(rough.parts.size(), 0);
    for (const Vec3& p : ring->point) ++points[nearest_part(rough.balls, p)];
    const auto most = std::max_element(points.begin(), points.end());
    if (static_cast<double>(*most) < kMostOfRing * static_cast<double>(ring->point.size()))
      continue;
    int part = static_cast<int>(most - points.begin());
    if (rough.parts[part].is_ring || is_part_of(*ring, rough, part)) {
      part = split_off(*ring, part, rough);
    }
    RoughPart& whole = rough.parts[part];
    whole.line = ring->point;
    whole.radius = ring->radius;
    whole.is_ring = whole.is_in_loop = true;
    whole.end_part = {-1, -1};
    known.push_back(*opening);
  }
}

}  // namespace palmar::product
