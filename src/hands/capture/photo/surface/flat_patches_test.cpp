// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/photo/surface/flat_patches.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::capture {
namespace {

constexpr double kVariance = 1.0;  // mm^2, of a patch in each direction, seen frontally

/// Points on a mesh' vertices, patches of one variance in the tangent plane.
PointCells frontal(const geometry::TriangleMesh& mesh, const auto& normal_of) {
  std::vector<SurfacePoint> points;
  for (const Vec3& vertex : mesh.vertices) {
    const Vec3 n = normal_of(vertex);
    const Eigen::Matrix3f s =
        (kVariance * (Eigen::Matrix3d::Identity() - n * n.transpose())).cast<float>();
    points.push_back({vertex.cast<float>(),
                      n.cast<float>(),
                      3,
                      {s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(0, 2), s(1, 2)}});
  }
  return PointCells(points);
}

/// An open tube about z.
geometry::TriangleMesh tube(double radius, double length, int round, int along) {
  geometry::TriangleMesh mesh;
  for (int k = 0; k <= along; ++k) {
    for (int i = 0; i < round; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / round;
      mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle),
                                 length * k / along);
    }
  }
  const auto at = [round](int i, int k) { return k * round + i % round; };
  for (int k = 0; k < along; ++k) {
    for (int i = 0; i < round; ++i) {
      mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  }
  return mesh;
}

TEST(FlatPatches, ARodGrowsByHalfTheVarianceOverItsRadius) {
  constexpr double kRadius = 8.0;
  geometry::TriangleMesh mesh = tube(kRadius, 30.0, 64, 40);
  const auto out = [](const Vec3& p) { return Vec3(p.x(), p.y(), 0).normalized(); };
  const geometry::TriangleMesh moved = without_flat_patches(mesh, frontal(mesh, out));
  for (const Vec3& p : moved.vertices) {
    if (p.z() < 6.0 || p.z() > 24.0) continue;
    EXPECT_NEAR(p.head<2>().norm(), kRadius + 0.5 * kVariance / kRadius, 0.004);
  }
  // The same tube as a hole: concave skin is too far out, so it moves in, away from the axis.
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  const auto in = [&](const Vec3& p) { return Vec3(-out(p)); };
  const geometry::TriangleMesh hole = without_flat_patches(mesh, frontal(mesh, in));
  for (const Vec3& p : hole.vertices) {
    if (p.z() < 6.0 || p.z() > 24.0) continue;
    EXPECT_NEAR(p.head<2>().norm(), kRadius + 0.5 * kVariance / kRadius, 0.004);
  }
}

TEST(FlatPatches, ABallGrowsTwiceAsMuchAndAPlaneStays) {
  constexpr double kRadius = 8.0;
  const geometry::TriangleMesh ball = geometry::make_icosphere(kRadius, 4);
  const geometry::TriangleMesh moved =
      without_flat_patches(ball, frontal(ball, [](const Vec3& p) { return p.normalized(); }));
  for (const Vec3& p : moved.vertices) EXPECT_NEAR(p.norm(), kRadius + kVariance / kRadius, 0.008);

  // Flat is the middle of a tube of 1 m in radius.
  const geometry::TriangleMesh wide = tube(1000.0, 20.0, 8000, 25);
  const auto out = [](const Vec3& p) { return Vec3(p.x(), p.y(), 0).normalized(); };
  const geometry::TriangleMesh same = without_flat_patches(wide, frontal(wide, out));
  for (const Vec3& p : same.vertices) EXPECT_NEAR(p.head<2>().norm(), 1000.0, 0.002);
}

TEST(FlatPatches, WhatNoPhotographSawStays) {
  const geometry::TriangleMesh ball = geometry::make_icosphere(8.0, 4);
  const geometry::TriangleMesh same = without_flat_patches(ball, PointCells({}));
  EXPECT_EQ(same.vertices, ball.vertices);
}

TEST(CameraHeights, OneOrTwo) {
  const auto ring = [](double elevation, double wobble) {
    std::vector<Vec3> centres;
    for (int i = 0; i < 18; ++i) {
      const double up = (elevation + wobble * std::sin(2.4 * i)) * std::numbers::pi / 180.0;
      centres.push_back(Vec3(0, 0, 90) + 450.0 * Vec3(std::cos(up) * std::cos(0.35 * i),
                                                      std::cos(up) * std::sin(0.35 * i),
                                                      std::sin(up)));
    }
    return centres;
  };
  std::vector<Vec3> low = ring(20.0, 3.0);
  EXPECT_TRUE(camera_heights(low, {0, 0, 90}).are_one);
  EXPECT_NEAR(camera_heights(low, {0, 0, 90}).usual, 20.0, 3.0);
  for (const Vec3& high : ring(45.0, 3.0)) low.push_back(high);
  EXPECT_FALSE(camera_heights(low, {0, 0, 90}).are_one);
}

}  // namespace
}  // namespace palmar::capture
