// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/parts/ring_parts.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "palmar/product/parts/loop_opening.h"
#include "palmar/product/parts/skeleton_rings.h"

namespace palmar {
namespace {

constexpr double kThickestRing = 22.5;  // mm of depth: the thickest bar that a hand closes round
constexpr double kEvenRing = 2.0;       // largest over median depth of a bar all round; choice
constexpr double kMostOfRing = 0.6;     // share of it that is one part's; choice
constexpr double kSameOpening = 0.3;    // of the disc's diameter between two middles; choice

std::vector<Vec3> in_product(const SolidGrid& grid, const std::vector<Vec3>& line) {
  std::vector<Vec3> result;
  for (const Vec3& p : line) result.push_back(grid.product_from_grid * p);
  return result;
}

bool is_even_bar(const SkeletonRing& ring) {
  std::vector<double> depth = ring.radius;
  if (depth.size() < 4) return false;
  std::sort(depth.begin(), depth.end());
  return depth.back() <= kThickestRing && depth.back() <= kEvenRing * depth[depth.size() / 2];
}

}  // namespace

void complete_rings(const TriangleMesh& mesh, const SolidGrid& grid, const SkeletonGraph& graph,
                    double finger, RoughParts& rough) {
  const std::vector<SkeletonRing> rings = rings_of(graph);
  if (rings.size() < 2) return;  // the line of a single ring is whole
  std::vector<PartOpening> known;
  for (const RoughPart& part : rough.parts) {
    if (!part.is_ring && !part.is_in_loop) continue;
    const auto opening = loop_opening(mesh, in_product(grid, part.line));
    if (opening && opening->disc >= finger) known.push_back(*opening);
  }
  for (const SkeletonRing& ring : rings) {
    if (!is_even_bar(ring)) continue;
    const auto opening = loop_opening(mesh, in_product(grid, ring.point));
    if (!opening || opening->disc < finger) continue;
    const bool is_known = std::any_of(known.begin(), known.end(), [&](const PartOpening& other) {
      return (other.centre - opening->centre).norm() < kSameOpening * opening->disc;
    });
    if (is_known) continue;
    std::vector<std::size_t> points(rough.parts.size(), 0);
    for (const Vec3& p : ring.point) ++points[nearest_part(rough.balls, p)];
    const auto most = std::max_element(points.begin(), points.end());
    if (static_cast<double>(*most) < kMostOfRing * static_cast<double>(ring.point.size())) continue;
    RoughPart& part = rough.parts[static_cast<std::size_t>(most - points.begin())];
    if (part.is_ring) continue;
    part.line = ring.point;
    part.radius = ring.radius;
    part.is_ring = part.is_in_loop = true;
    part.end_part = {-1, -1};
    known.push_back(*opening);
  }
}

}  // namespace palmar
