// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/even_patches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/remesh/split_edges.h"
#include "palmar/product/primitives.h"

namespace palmar::redesign {
namespace {

/// Longest edge over the height on it.
double aspect(const geometry::TriangleMesh& mesh, const Triangle& t) {
  const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
  const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  return longest * longest / (b - a).cross(c - a).norm();
}

TEST(EvenPatches, StripsBecomeEvenTrianglesOnTheSameSurface) {
  // A brick of long triangles with a fillet round its edges, split to 2 mm: slivers.
  product::PrismProductOptions options;
  options.width = 40.0;
  options.depth = 30.0;
  options.length = 100.0;
  options.fillet_radius = 3.0;
  constexpr double kEdge = 2.0;
  const geometry::TriangleMesh brick =
      geometry::split_long_edges(product::make_prism_product(options).mesh, kEdge,
                                 [](const Vec3&, const Vec3&, const Vec3&) { return true; });
  const std::vector<int> all(brick.triangles.size(), 0);
  const geometry::TriangleMesh even = with_even_patches(brick, all, kEdge);
  EXPECT_TRUE(geometry::examine_topology(even).is_closed);
  EXPECT_NEAR(geometry::signed_volume(even), geometry::signed_volume(brick),
              1e-3 * geometry::signed_volume(brick));
  int slim = 0;
  double longest = 0.0;
  for (const Triangle& t : even.triangles) {
    slim += aspect(even, t) > 4.0 ? 1 : 0;
    for (int k = 0; k < 3; ++k) {
      longest = std::max(longest, (even.vertices[t[k]] - even.vertices[t[(k + 1) % 3]]).norm());
    }
  }
  EXPECT_LT(slim, 0.02 * even.triangle_count());
  EXPECT_LT(longest, 1.05 * kEdge);
  // The rims of the flat ends are creases: all of their vertices are there still.
  std::set<std::array<double, 3>> there;
  for (const Vec3& x : even.vertices) there.insert({x.x(), x.y(), x.z()});
  const auto [low, high] =
      std::minmax_element(brick.vertices.begin(), brick.vertices.end(),
                          [](const Vec3& a, const Vec3& b) { return a.z() < b.z(); });
  int rim = 0;
  for (const Vec3& x : brick.vertices) {
    const bool is_end = x.z() == low->z() || x.z() == high->z();
    if (!is_end || std::max(std::abs(x.x()) - 17.0, std::abs(x.y()) - 12.0) < 2.999) continue;
    ++rim;
    EXPECT_TRUE(there.count({x.x(), x.y(), x.z()})) << x.transpose();
  }
  EXPECT_GT(rim, 50);
}

TEST(EvenPatches, WhatIsNotChosenKeepsItsTriangles) {
  product::CylinderProductOptions options;
  options.diameter = 40.0;
  const geometry::TriangleMesh bar =
      geometry::split_long_edges(product::make_cylinder_product(options).mesh, 2.0,
                                 [](const Vec3&, const Vec3&, const Vec3&) { return true; });
  std::vector<int> upper;
  for (const Triangle& t : bar.triangles) upper.push_back(bar.vertices[t[0]].z() > 0.0 ? 0 : -1);
  const geometry::TriangleMesh even = with_even_patches(bar, upper, 2.0);
  EXPECT_TRUE(geometry::examine_topology(even).is_closed);
  using Corners = std::array<std::array<double, 3>, 3>;
  const auto corners = [](const geometry::TriangleMesh& mesh, const Triangle& t) {
    Corners c;
    for (int k = 0; k < 3; ++k) {
      const Vec3& x = mesh.vertices[t[k]];
      c[k] = {x.x(), x.y(), x.z()};
    }
    return c;
  };
  std::set<Corners> there;
  for (const Triangle& t : even.triangles) there.insert(corners(even, t));
  for (int t = 0; t < bar.triangle_count(); ++t) {
    if (upper[t] >= 0) continue;
    EXPECT_TRUE(there.count(corners(bar, bar.triangles[t])));
  }
}

}  // namespace
}  // namespace palmar::redesign
