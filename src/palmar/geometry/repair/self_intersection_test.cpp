// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/repair/self_intersection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::geometry {
namespace {

using ::testing::ElementsAre;
using Corners = std::array<Vec3, 3>;

const Corners kFloor{Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};

TriangleMesh both_of(TriangleMesh a, const TriangleMesh& b, const Vec3& shift) {
  const int count = a.vertex_count();
  for (const Vec3& v : b.vertices) a.vertices.push_back(v + shift);
  for (const Triangle& t : b.triangles) {
    a.triangles.push_back({t[0] + count, t[1] + count, t[2] + count});
  }
  return a;
}

TEST(DoTrianglesCross, SeesASpikeThroughTheFloorInEitherOrder) {
  const Corners spike{Vec3(1, 1, -1), Vec3(1, 1.5, 1), Vec3(1.5, 1, 1)};
  EXPECT_TRUE(do_triangles_cross(kFloor, spike));
  EXPECT_TRUE(do_triangles_cross(spike, kFloor));
}

TEST(DoTrianglesCross, DoesNotCountTouchingOrCoplanarTriangles) {
  EXPECT_FALSE(do_triangles_cross(kFloor, {Vec3(1, 1, 0), Vec3(1, 2, 1), Vec3(2, 1, 1)}));  // tip
  EXPECT_FALSE(do_triangles_cross(kFloor, {Vec3(1, 1, 0), Vec3(2, 1, 0), Vec3(1, 1, 5)}));  // edge
  EXPECT_FALSE(do_triangles_cross(kFloor, {Vec3(1, 1, 0), Vec3(2, 1, 0), Vec3(1, 2, 0)}));
  EXPECT_FALSE(do_triangles_cross(kFloor, {Vec3(1, 1, 1), Vec3(2, 1, 1), Vec3(1, 2, 1)}));
  EXPECT_FALSE(do_triangles_cross(kFloor, {Vec3(9, 9, -1), Vec3(9, 8, 1), Vec3(8, 9, 1)}));
  EXPECT_FALSE(do_triangles_cross(kFloor, kFloor));
}

TEST(DoTrianglesCross, AtASharedCornerLooksAtTheOppositeEdge) {
  const Corners through{Vec3(0, 0, 0), Vec3(2, 1, -1), Vec3(1, 2, 1)};
  const Corners above{Vec3(0, 0, 0), Vec3(2, 1, 0.5), Vec3(1, 2, 1)};
  EXPECT_TRUE(do_triangles_cross(kFloor, through));
  EXPECT_TRUE(do_triangles_cross(through, kFloor));
  EXPECT_FALSE(do_triangles_cross(kFloor, above));
}

TEST(DoTrianglesCross, AgreesWithAnotherEdgeTestOnRandomTriangles) {
  // Edge against triangle by the ray formula of Moeller and Trumbore 1997.
  std::mt19937 random(17);
  std::uniform_real_distribution<double> in_box(-1.0, 1.0);
  const auto corner = [&] {
    const double x = in_box(random), y = in_box(random), z = in_box(random);
    return Vec3(x, y, z);
  };
  const auto hits = [](const Vec3& p, const Vec3& q, const Corners& t) {
    const Vec3 e1 = t[1] - t[0], e2 = t[2] - t[0], d = q - p, s = p - t[0];
    const double det = e1.dot(d.cross(e2));
    const double u = s.dot(d.cross(e2)) / det, v = d.dot(s.cross(e1)) / det;
    const double w = e2.dot(s.cross(e1)) / det;
    return u >= 0 && v >= 0 && u + v <= 1 && w >= 0 && w <= 1;
  };
  int crossing = 0;
  for (int i = 0; i < 2000; ++i) {
    const Corners s{corner(), corner(), corner()}, t{corner(), corner(), corner()};
    bool expected = false;
    for (size_t k = 0; k < 3; ++k) {
      expected |= hits(s[k], s[(k + 1) % 3], t) || hits(t[k], t[(k + 1) % 3], s);
    }
    EXPECT_EQ(do_triangles_cross(s, t), expected) << i;
    crossing += expected;
  }
  EXPECT_GT(crossing, 200);
}

TEST(FindSelfCrossings, FindsNoneOnSoundMeshes) {
  EXPECT_TRUE(find_self_crossings({}).empty());
  EXPECT_TRUE(find_self_crossings(make_icosphere(10.0, 4)).empty());
  EXPECT_TRUE(find_self_crossings(make_torus(10.0, 3.0, 60, 20)).empty());
  EXPECT_TRUE(find_self_crossings(make_box({1, 2, 3}, 6)).empty());
}

TEST(FindSelfCrossings, MatchesTestingEveryPair) {
  std::mt19937 random(23);
  std::uniform_real_distribution<double> in_box(-5.0, 5.0);
  std::uniform_real_distribution<double> spread(-1.2, 1.2);
  TriangleMesh soup;
  for (int t = 0; t < 400; ++t) {
    Vec3 centre;
    for (int d = 0; d < 3; ++d) centre[d] = in_box(random);
    for (int k = 0; k < 3; ++k) {
      Vec3 v = centre;
      for (int d = 0; d < 3; ++d) v[d] += spread(random);
      soup.vertices.push_back(v);
    }
    soup.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  const auto corners = [&](int t) {
    const int v = 3 * t;
    return Corners{soup.vertices[v], soup.vertices[v + 1], soup.vertices[v + 2]};
  };
  std::vector<std::array<int, 2>> expected;
  for (int i = 0; i < 400; ++i) {
    for (int j = i + 1; j < 400; ++j) {
      if (do_triangles_cross(corners(i), corners(j))) expected.push_back({i, j});
    }
  }
  EXPECT_GT(expected.size(), 50U);
  EXPECT_EQ(find_self_crossings(soup), expected);
}

TEST(FindSelfCrossings, SeesTwoTrianglesOfOneFanThatPassThroughEachOther) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {2, 1, -1}, {1, 2, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 4}};
  EXPECT_THAT(find_self_crossings(mesh), ElementsAre(std::array{0, 1}));
}

TEST(CrossingDepth, OfTwoOverlappingSpheresIsTheThicknessOfTheLens) {
  for (const double depth : {0.3, 1.0, 3.0}) {
    // Off the axes, so that nothing meets edge on edge.
    const Vec3 shift = (20.0 - depth) * Vec3(1.0, 0.013, 0.007).normalized();
    const TriangleMesh ball = make_icosphere(10.0, 4);
    const TriangleMesh both = both_of(ball, ball, shift);
    const CrossingDepth result = crossing_depth(both);
    EXPECT_FALSE(result.pairs.empty());
    // Vertices needn't stand at the deepest place; a triangle lies up to 0.03 mm inside its ball.
    EXPECT_NEAR(result.deepest, depth, 0.2);
    EXPECT_LE(result.deepest, depth);
    ASSERT_EQ(result.vertex.size(), result.depth.size());
    for (size_t i = 0; i < result.vertex.size(); ++i) {
      const Vec3& v = both.vertices[result.vertex[i]];
      const Vec3 other = result.vertex[i] < ball.vertex_count() ? shift : Vec3(Vec3::Zero());
      EXPECT_NEAR(result.depth[i], 10.0 - (v - other).norm(), 0.05);
    }
  }
}

TEST(CrossingDepth, OfACreaseIsTheThicknessOfItsOverlap) {
  // A rod bent sharply by 40 deg about the x axis through its middle, where its halves end 0.25 mm
  // from the axis. In the plane of bending the overlap is the triangle between the flanks and the
  // line from the end of one, (y, z) = (10, -0.25), to that of the other, which by symmetry is
  // inclined by 20 deg: at (10, -s) the overlap is (s - 0.25) tan 20 deg thick along y.
  TriangleMesh rod = make_cylinder({.radius = 10.0, .length = 80.5, .segments = 64, .rings = 161});
  const double bend = 40.0 * std::acos(-1.0) / 180.0, slope = std::tan(0.5 * bend);
  for (Vec3& v : rod.vertices) {
    if (v.z() <= 0.0) continue;
    const double y = v.y(), z = v.z();
    v.y() = std::cos(bend) * y + std::sin(bend) * z;
    v.z() = -std::sin(bend) * y + std::cos(bend) * z;
  }
  const CrossingDepth result = crossing_depth(rod);
  EXPECT_FALSE(result.pairs.empty());
  int checked = 0;
  for (size_t i = 0; i < result.vertex.size(); ++i) {
    const Vec3& v = rod.vertices[result.vertex[i]];
    const double s = -v.z();
    if (std::abs(v.x()) > 1e-9 || std::abs(v.y() - 10.0) > 1e-9 || s < 0.6) continue;
    EXPECT_LT(s, 10.0 * slope);
    EXPECT_NEAR(result.depth[i], (s - 0.25) * slope, 1e-6);
    ++checked;
  }
  EXPECT_EQ(checked, 6);  // rings at s = 0.75, 1.25, ... 3.25
}

TEST(CrossingDepth, IsZeroWithoutCrossings) {
  const CrossingDepth result = crossing_depth(make_icosphere(3.0, 2));
  EXPECT_TRUE(result.pairs.empty());
  EXPECT_TRUE(result.vertex.empty());
  EXPECT_EQ(result.deepest, 0.0);
}

TEST(CrossingDepth, RefusesOpenMeshesAndCoordinatesThatAreNoNumbers) {
  EXPECT_THROW(crossing_depth(make_grid_patch(2, 2, 1.0)), InputError);
  TriangleMesh broken = make_icosphere(1.0, 0);
  broken.vertices[0].x() = std::nan("");
  EXPECT_THROW(find_self_crossings(broken), InputError);
}

}  // namespace
}  // namespace palmar::geometry
