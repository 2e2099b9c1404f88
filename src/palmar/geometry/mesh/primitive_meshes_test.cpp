// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/mesh/primitive_meshes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"

namespace palmar::geometry {
namespace {

TEST(MakeIcosphere, HasTheCountsOfASubdividedIcosahedronOnTheSphere) {
  for (int level = 0; level <= 4; ++level) {
    const TriangleMesh mesh = make_icosphere(7.0, level);
    const int quarters = 1 << (2 * level);
    EXPECT_EQ(mesh.vertex_count(), 10 * quarters + 2);
    EXPECT_EQ(mesh.triangle_count(), 20 * quarters);
    for (const Vec3& v : mesh.vertices) EXPECT_NEAR(v.norm(), 7.0, 1e-12);
    const TopologyReport report = examine_topology(mesh);
    EXPECT_TRUE(report.is_closed && report.is_two_manifold && report.is_oriented);
    EXPECT_EQ(report.euler_number, 2);
  }
}

TEST(MakeIcosphere, VolumeAndAreaConvergeToTheSphereWithTheSquareOfTheEdge) {
  const double volume = 4.0 / 3.0 * std::numbers::pi, area = 4.0 * std::numbers::pi;
  double volume_error = 1.0, area_error = 1.0;
  for (int level = 1; level <= 5; ++level) {
    const TriangleMesh mesh = make_icosphere(1.0, level);
    const double v = (volume - signed_volume(mesh)) / volume;
    const double a = (area - surface_area(mesh)) / area;
    EXPECT_GT(v, 0.0);
    EXPECT_GT(a, 0.0);
    if (level > 2) {
      EXPECT_NEAR(volume_error / v, 4.0, 0.3);  // second order: a quarter per halving
      EXPECT_NEAR(area_error / a, 4.0, 0.3);
    }
    volume_error = v;
    area_error = a;
  }
  EXPECT_LT(volume_error, 1e-3);
}

TEST(MakeBox, HasItsVolumeAndAreaWhateverTheDivisions) {
  for (const int divisions : {1, 2, 5}) {
    const TriangleMesh mesh = make_box({2.0, 3.0, 5.0}, divisions);
    EXPECT_NEAR(signed_volume(mesh), 30.0, 1e-12);
    EXPECT_NEAR(surface_area(mesh), 62.0, 1e-12);
    EXPECT_EQ(mesh.triangle_count(), 12 * divisions * divisions);
    const TopologyReport report = examine_topology(mesh);
    EXPECT_TRUE(report.is_closed && report.is_two_manifold && report.is_oriented);
    EXPECT_EQ(report.euler_number, 2);
  }
}

TEST(MakeGridPatch, CoversTheRectangleFacingUp) {
  const TriangleMesh mesh = make_grid_patch(4, 3, 0.5);
  EXPECT_NEAR(surface_area(mesh), 3.0, 1e-14);
  for (const Vec3& n : triangle_normals(mesh)) EXPECT_EQ(n, Vec3::UnitZ());
  EXPECT_EQ(examine_topology(mesh).euler_number, 1);
  EXPECT_EQ(mesh.vertices[1 * 5 + 2], Vec3(1.0, 0.5, 0.0));
}

TEST(MakeLatticePatch, IsMadeOfEquilateralTrianglesFacingUp) {
  const double spacing = 2.5;
  const TriangleMesh mesh = make_lattice_patch(25.0, spacing);
  EXPECT_EQ(mesh.vertices.front(), Vec3::Zero());
  for (const Triangle& t : mesh.triangles) {
    for (size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR((mesh.vertices[t[k]] - mesh.vertices[t[(k + 1) % 3]]).norm(), spacing, 1e-12);
    }
  }
  for (const Vec3& n : triangle_normals(mesh)) EXPECT_NEAR(n.z(), 1.0, 1e-14);
  const TopologyReport report = examine_topology(mesh);
  EXPECT_TRUE(report.is_two_manifold);
  EXPECT_EQ(report.used_vertices, mesh.vertex_count());
  EXPECT_EQ(report.euler_number, 1);
  EXPECT_EQ(report.boundary_loops, 1);
  EXPECT_NEAR(vertex_areas(mesh)[0], spacing * spacing * std::sqrt(3.0) / 2.0, 1e-12);
}

TEST(MakeLatticePatch, WithARadiusOfOneSpacingIsAHexagon) {
  const TriangleMesh mesh = make_lattice_patch(3.0, 3.0);
  EXPECT_EQ(mesh.vertex_count(), 7);
  EXPECT_EQ(mesh.triangle_count(), 6);
}

TEST(MakeCylinder, CappedHasTheVolumeOfThePrism) {
  const CylinderOptions options{.radius = 24.0, .length = 120.0, .segments = 37, .rings = 9};
  const TriangleMesh mesh = make_cylinder(options);
  const double base = 0.5 * 37 * 24.0 * 24.0 * std::sin(2.0 * std::numbers::pi / 37);
  EXPECT_NEAR(signed_volume(mesh), base * 120.0, 1e-8);
  const double side = 2.0 * 37 * 24.0 * std::sin(std::numbers::pi / 37) * 120.0;
  EXPECT_NEAR(surface_area(mesh), side + 2.0 * base, 1e-8);
  const TopologyReport report = examine_topology(mesh);
  EXPECT_TRUE(report.is_closed && report.is_two_manifold && report.is_oriented);
  EXPECT_EQ(report.euler_number, 2);
}

TEST(MakeCylinder, CapsAreWellShapedForAnyNumberOfSegments) {
  for (const int segments : {3, 4, 5, 6, 7, 12, 48, 101}) {
    const TriangleMesh mesh =
        make_cylinder({.radius = 10.0, .length = 10.0, .segments = segments, .rings = 1});
    const TopologyReport report = examine_topology(mesh);
    EXPECT_TRUE(report.is_closed && report.is_two_manifold && report.is_oriented) << segments;
    for (const Vec3& n : triangle_normals(mesh)) EXPECT_NEAR(n.norm(), 1.0, 1e-12);
    EXPECT_NEAR(bounding_box(mesh).sizes().z(), 10.0, 1e-12);
  }
}

TEST(MakeCylinder, OpenTubeHasTwoBorders) {
  const TriangleMesh mesh =
      make_cylinder({.radius = 5.0, .length = 8.0, .segments = 12, .rings = 3, .is_capped = false});
  const TopologyReport report = examine_topology(mesh);
  EXPECT_EQ(report.boundary_loops, 2);
  EXPECT_EQ(report.boundary_edges, 24);
  EXPECT_EQ(report.euler_number, 0);
}

TEST(MakeTorus, HasEulerNumberZeroAndTheVolumeOfPappus) {
  const TriangleMesh mesh = make_torus(30.0, 8.0, 200, 80);
  const TopologyReport report = examine_topology(mesh);
  EXPECT_TRUE(report.is_closed && report.is_two_manifold && report.is_oriented);
  EXPECT_EQ(report.euler_number, 0);
  const double volume = 2.0 * std::numbers::pi * std::numbers::pi * 30.0 * 64.0;
  EXPECT_NEAR(signed_volume(mesh) / volume, 1.0, 2e-3);
  EXPECT_LT(signed_volume(mesh), volume);
}

TEST(PrimitiveMeshes, RefuseSizesThatCloseNoShape) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(make_icosphere(0.0, 1), UsageError);
  EXPECT_THROW(make_icosphere(nan, 1), UsageError);
  EXPECT_THROW(make_icosphere(1.0, 9), UsageError);
  EXPECT_THROW(make_box({1.0, -1.0, 1.0}), UsageError);
  EXPECT_THROW(make_grid_patch(0, 1, 1.0), UsageError);
  EXPECT_THROW(make_lattice_patch(1.0, 2.0), UsageError);
  EXPECT_THROW(make_torus(1.0, 2.0, 10, 10), UsageError);
  try {
    make_cylinder({.radius = 5.0, .length = 8.0, .segments = 2});
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(), "cylinder: segments is 2; allowed are 3 to 10000");
  }
}

}  // namespace
}  // namespace palmar::geometry
