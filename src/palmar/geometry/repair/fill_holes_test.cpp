// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/repair/fill_holes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/geometry/degrees.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/geometry/repair/hole_patch.h"
#include "palmar/geometry/repair/self_intersection.h"

namespace palmar::geometry {
namespace {

using testing::HasSubstr;

/// The mesh without the triangles that `is_gone` of their centre.
template <typename IsGone>
TriangleMesh without(const TriangleMesh& mesh, const IsGone& is_gone) {
  TriangleMesh result = mesh;
  std::erase_if(result.triangles, [&](const Triangle& t) {
    return is_gone(Vec3((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0));
  });
  return result;
}

TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b, const Vec3& shift) {
  TriangleMesh result = a;
  for (const Vec3& x : b.vertices) result.vertices.push_back(x + shift);
  for (const Triangle& t : b.triangles) {
    const int n = a.vertex_count();
    result.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  }
  return result;
}

TEST(BoundaryLoops, OfATubeAreItsTwoRims) {
  const TriangleMesh tube = make_cylinder({.radius = 10, .segments = 36, .is_capped = false});
  const BoundaryLoops found = find_boundary_loops(tube, build_topology(tube));
  ASSERT_EQ(found.loops.size(), 2u);
  EXPECT_EQ(found.loose_edges, 0);
  for (const BoundaryLoop& loop : found.loops) {
    EXPECT_EQ(loop.size(), 36);
    EXPECT_NEAR(loop.perimeter, 36 * 2.0 * 10.0 * std::sin(std::numbers::pi / 36), 1e-9);
    EXPECT_NEAR(std::abs(loop.centre.z()), 50.0, 1e-9);
    EXPECT_NEAR(loop.centre.head<2>().norm(), 0.0, 1e-9);
  }
}

TEST(BoundaryLoops, ThatTouchInACornerAreTwo) {
  TriangleMesh grid = make_grid_patch(6, 6, 1.0);
  // The squares (2, 2) and (3, 3) touch in the grid's middle.
  grid = without(grid, [](const Vec3& x) {
    const auto in = [&](double a) {
      return x.x() > a && x.x() < a + 1 && x.y() > a && x.y() < a + 1;
    };
    return in(2) || in(3);
  });
  const BoundaryLoops found = find_boundary_loops(grid, build_topology(grid));
  ASSERT_EQ(found.loops.size(), 3u);
  std::vector<int> sizes;
  for (const BoundaryLoop& loop : found.loops) sizes.push_back(loop.size());
  std::sort(sizes.begin(), sizes.end());
  EXPECT_EQ(sizes, (std::vector<int>{4, 4, 24}));
  const FillHolesResult filled = fill_holes(grid, {.longest_perimeter = 5.0});
  EXPECT_EQ(filled.filled, 2);
  EXPECT_NEAR(surface_area(filled.mesh), 36.0, 1e-12);
  EXPECT_TRUE(examine_topology(filled.mesh).is_two_manifold);
}

TEST(BoundaryLoops, OfAClosedMeshAreNone) {
  const TriangleMesh ball = make_icosphere(10, 2);
  EXPECT_TRUE(find_boundary_loops(ball, build_topology(ball)).loops.empty());
  const FillHolesResult filled = fill_holes(ball);
  EXPECT_EQ(filled.mesh.triangles, ball.triangles);
  EXPECT_EQ(filled.mesh.vertices, ball.vertices);
}

TEST(FillHoles, AFlatHoleIsFilledFlat) {
  const TriangleMesh grid = without(make_grid_patch(20, 20, 1.0), [](const Vec3& x) {
    return (x - Vec3(10, 10, 0)).norm() < 4.2;
  });
  const FillHolesResult filled = fill_holes(grid, {.longest_perimeter = 40.0});
  ASSERT_EQ(filled.filled, 1);
  EXPECT_NEAR(surface_area(filled.mesh), 400.0, 1e-9);
  for (const Vec3& x : filled.mesh.vertices) EXPECT_NEAR(x.z(), 0.0, 1e-9);
  const TopologyReport report = examine_topology(filled.mesh);
  EXPECT_TRUE(report.is_two_manifold);
  EXPECT_TRUE(report.is_oriented);
  EXPECT_EQ(report.euler_number, 1);
  // As fine as the surface round it, without needles.
  const std::vector<double> angles = smallest_angles(filled.mesh);
  EXPECT_GT(*std::min_element(angles.begin(), angles.end()), 12.0 * kDegree);
  EXPECT_LT(edge_lengths(filled.mesh).longest, 2.3);
}

TEST(FillHoles, OfABallGoOnRound) {
  const double radius = 30.0;
  const TriangleMesh ball = without(make_icosphere(radius, 4),
                                    [&](const Vec3& x) { return x.z() > radius * std::cos(0.35); });
  const FillHolesResult filled = fill_holes(ball, {.longest_perimeter = 80.0});
  ASSERT_EQ(filled.filled, 1);
  const TopologyReport report = examine_topology(filled.mesh);
  EXPECT_TRUE(report.is_closed);
  EXPECT_TRUE(report.is_two_manifold);
  EXPECT_EQ(report.euler_number, 2);
  // A flat lid would lie r (1 - cos 0.35) = 1.8 mm too deep.
  for (const Vec3& x : filled.mesh.vertices) EXPECT_NEAR(x.norm(), radius, 0.7);
  EXPECT_NEAR(signed_volume(filled.mesh), 4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3),
              400.0);
  EXPECT_TRUE(find_self_crossings(filled.mesh).empty());
}

TEST(FillHoles, LeavesWhatIsNoHole) {
  const TriangleMesh tube = make_cylinder({.radius = 10, .is_capped = false});
  const FillHolesResult left = fill_holes(tube, {.longest_perimeter = 50.0});
  EXPECT_EQ(left.filled, 0);
  EXPECT_THAT(left.holes[0].reason, HasSubstr("up to 50 mm are filled"));
  const TriangleMesh half = without(make_icosphere(10, 3), [](const Vec3& x) { return x.z() > 0; });
  EXPECT_THAT(fill_holes(half, {.longest_perimeter = 100}).holes[0].reason, HasSubstr("is a hole"));
  const TriangleMesh one{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {{0, 1, 2}}};
  EXPECT_THAT(fill_holes(one).holes[0].reason, HasSubstr("outline of one triangle"));
}

TEST(FillHoles, LeavesAHoleWithAnIsland) {
  // A ring-shaped slot: its outer rim is a hole round the piece in the middle.
  const TriangleMesh grid = without(make_grid_patch(30, 30, 1.0), [](const Vec3& x) {
    const double r = (x - Vec3(15, 15, 0)).norm();
    return r > 3.0 && r < 5.0;
  });
  for (const HoleOutcome& hole : fill_holes(grid, {.longest_perimeter = 60.0}).holes) {
    EXPECT_FALSE(hole.is_filled);
    if (hole.loop.perimeter > 28 && hole.loop.perimeter < 60) {
      EXPECT_THAT(hole.reason, HasSubstr("another open edge"));
    }
  }
}

TEST(FillHoles, LeavesAHoleThatSomethingGoesThrough) {
  const TriangleMesh ball =
      without(make_icosphere(30, 4), [](const Vec3& x) { return x.z() > 28; });
  const TriangleMesh spike = make_cylinder({.radius = 1.0, .length = 30, .segments = 12});
  const FillHolesResult filled =
      fill_holes(joined(ball, spike, Vec3(0, 0, 28)), {.longest_perimeter = 100.0});
  ASSERT_EQ(filled.holes.size(), 1u);
  EXPECT_FALSE(filled.holes[0].is_filled);
  EXPECT_THAT(filled.holes[0].reason, HasSubstr("go through the surface"));
}

TEST(FillHoles, NamesOptionsOutOfRange) {
  const TriangleMesh ball = make_icosphere(10, 1);
  EXPECT_THROW(fill_holes(ball, {.longest_perimeter = -1.0}), UsageError);
  EXPECT_THROW(fill_holes(ball, {.longest_perimeter = std::numeric_limits<double>::infinity()}),
               UsageError);
  EXPECT_THROW(fill_holes(ball, {.largest_share = 0.0}), UsageError);
  TriangleMesh broken = ball;
  broken.vertices[3].y() = std::nan("");
  EXPECT_THROW(fill_holes(broken), InputError);
}

std::vector<Vec3> star(int corners) {
  std::vector<Vec3> ring;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / corners, r = i % 2 == 0 ? 10.0 : 6.0;
    ring.emplace_back(r * std::cos(angle), r * std::sin(angle), 0.0);
  }
  return ring;
}

TEST(HolePatch, OfAStarHasTheStarsArea) {
  for (const int corners : {10, 60, 200, 202, 600}) {
    const std::vector<Vec3> ring = star(corners);
    const auto patch = triangulate_ring(ring, [](int, int) { return false; });
    ASSERT_TRUE(patch) << corners;
    EXPECT_EQ(patch->triangle_count(), corners - 2);
    // Shoelace formula: n triangles from the middle.
    EXPECT_NEAR(surface_area(*patch),
                corners * 0.5 * 10 * 6 * std::sin(2 * std::numbers::pi / corners), 1e-6);
  }
  EXPECT_FALSE(triangulate_ring(star(10), [](int, int) { return true; }));
  EXPECT_FALSE(triangulate_ring(star(3000), [](int, int) { return false; }));
}

}  // namespace
}  // namespace palmar::geometry
