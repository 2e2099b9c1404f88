// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/tetra/tetrahedral_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/geometry/tetra/tetrahedral_lattice.h"

namespace palmar::geometry {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

double least_angle(const TetrahedralMesh& mesh) {
  const std::vector<double> angles = smallest_dihedral_angles(mesh);
  return *std::min_element(angles.begin(), angles.end());
}

ClipSurface ball(double radius, double sign) {
  return [=](const std::vector<Vec3>& points) {
    std::vector<ClipSample> result;
    for (const Vec3& x : points) {
      result.push_back({sign * (x.norm() - radius), radius * x.normalized()});
    }
    return result;
  };
}

TEST(TetrahedralMesh, RegularTetrahedronHasItsVolumeAndAngle) {
  const TetrahedralMesh mesh{{Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, 1, -1), Vec3(-1, -1, 1)},
                             {{0, 2, 1, 3}}};
  EXPECT_NEAR(std::abs(volume(mesh)), 8.0 / 3.0, 1e-12);
  EXPECT_NEAR(least_angle(mesh), std::acos(1.0 / 3.0), 1e-12);
  EXPECT_EQ(boundary_faces(mesh).size(), 4U);
}

TEST(TetrahedralLattice, UniformOneHasDihedralAnglesOf60And90Degrees) {
  const TetrahedralMesh lattice =
      make_tetrahedral_lattice(Box3(Vec3(0, 0, 0), Vec3(8, 8, 8)), {.edge = 2.0});
  EXPECT_NEAR(least_angle(lattice), 60.0 * kDegree, 1e-9);
  for (const Tetrahedron& t : lattice.tetrahedra) {
    const auto& x = lattice.vertices;
    EXPECT_NEAR(tetrahedron_volume(x[t[0]], x[t[1]], x[t[2]], x[t[3]]), 8.0 / 12.0, 1e-12);
  }
}

TEST(TetrahedralLattice, GradedOneHasNoGapsInside) {
  LatticeOptions options{.edge = 2.0, .levels = 3, .is_split = {}, .is_wanted = {}};
  options.is_split = [](const LatticeCube& cube) {
    return (cube.centre - Vec3(3, 0, 0)).norm() < 2.5;
  };
  const TetrahedralMesh lattice =
      make_tetrahedral_lattice(Box3(Vec3(-8, -8, -8), Vec3(8, 8, 8)), options);
  for (const Triangle& face : boundary_faces(lattice)) {
    const Vec3 middle =
        (lattice.vertices[face[0]] + lattice.vertices[face[1]] + lattice.vertices[face[2]]) / 3.0;
    EXPECT_GT(middle.cwiseAbs().maxCoeff(), 6.5);
  }
  EXPECT_GT(least_angle(lattice), 30.0 * kDegree);  // Labelle, Shewchuk 2007: bisected ones
}

TEST(TetrahedralLattice, BadOptionsAreNamed) {
  const Box3 box(Vec3(0, 0, 0), Vec3(1, 1, 1));
  try {
    make_tetrahedral_lattice(box, {.edge = -2.0});
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("edge is -2"));
  }
  EXPECT_THROW(make_tetrahedral_lattice(box, {.edge = 1.0, .levels = 9}), UsageError);
}

TEST(ClipTetrahedra, ShellBetweenTwoSpheresHasItsVolumeAndNoGaps) {
  double last = 1.0;
  for (const double edge : {2.0, 1.0}) {
    const TetrahedralMesh lattice =
        make_tetrahedral_lattice(Box3(Vec3(-6.1, -6.2, -6.3), Vec3(6, 6, 6)), {.edge = edge});
    const ClippedMesh outer = clip_tetrahedra(lattice, ball(5.0, 1.0), 0.23);
    const ClippedMesh shell =
        clip_tetrahedra(outer.mesh, ball(2.5, -1.0), 0.23, outer.is_on_surface);
    const double truth = 4.0 / 3.0 * std::numbers::pi * (125.0 - 15.625);
    const double error = std::abs(volume(shell.mesh) / truth - 1.0);
    EXPECT_LT(error, 0.4 * last);  // second order
    last = error;
    EXPECT_GT(least_angle(shell.mesh), 6.0 * kDegree);
    // Every face of the boundary is on one of the spheres.
    for (const Triangle& face : boundary_faces(shell.mesh)) {
      const double r = shell.mesh.vertices[face[0]].norm();
      for (const int v : face) {
        EXPECT_NEAR(shell.mesh.vertices[v].norm(), r > 3.5 ? 5.0 : 2.5, 0.3 * edge);
      }
    }
  }
  EXPECT_LT(last, 0.02);
}

}  // namespace
}  // namespace palmar::geometry
