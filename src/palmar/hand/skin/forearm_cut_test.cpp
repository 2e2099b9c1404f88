// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/skin/forearm_cut.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"

namespace palmar::hand {
namespace {

constexpr int kAround = 12;

/// Tube along y from a wavy rim near y = -20 to y = 40, closed by fans over corner 0 of each rim.
geometry::TriangleMesh stub(double wave) {
  geometry::TriangleMesh mesh;
  for (const double y : {-20.0, 40.0}) {
    for (int k = 0; k < kAround; ++k) {
      const double a = 2 * std::numbers::pi * k / kAround;
      const double up = y < 0 ? wave * (k % 2 == 0 ? 1 : -1) : 0;
      mesh.vertices.emplace_back(20 * std::sin(a), y + up, 20 * std::cos(a));
    }
  }
  for (int k = 0; k < kAround; ++k) {
    const int n = (k + 1) % kAround;
    mesh.triangles.push_back({k, n, kAround + n});
    mesh.triangles.push_back({k, kAround + n, kAround + k});
  }
  for (int k = 1; k + 1 < kAround; ++k) {
    mesh.triangles.push_back({0, k + 1, k});
    mesh.triangles.push_back({kAround, kAround + k, kAround + k + 1});
  }
  return mesh;
}

TEST(ForearmCut, WavyRimBecomesPlaneAndTheSkinStaysClosed) {
  const geometry::TriangleMesh wavy = stub(1.0);
  const geometry::TriangleMesh even = with_even_cut(wavy);
  geometry::require_closed_manifold(even, "stub");
  EXPECT_GT(even.vertex_count(), wavy.vertex_count());
  for (const Vec3& v : even.vertices) {
    if (v.y() < 0) {
      EXPECT_NEAR(v.y(), -20.0, 1e-9);  // the mean of the wave
    }
  }
  // Of a twelve-sided prism 60 mm high, radius 20 mm.
  EXPECT_NEAR(geometry::signed_volume(even), 60 * 6 * 400 * std::sin(std::numbers::pi / 6), 1e-6);
}

TEST(ForearmCut, SkinWithoutACutComesBackAsItIs) {
  geometry::TriangleMesh distal = stub(0.0);
  for (Vec3& v : distal.vertices) v.y() += 50;
  EXPECT_EQ(with_even_cut(distal).vertices, distal.vertices);
  EXPECT_EQ(with_even_cut(distal).triangles, distal.triangles);
}

}  // namespace
}  // namespace palmar::hand
