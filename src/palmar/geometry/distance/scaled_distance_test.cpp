// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/distance/scaled_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "palmar/geometry/distance/mesh_distance.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::geometry {
namespace {

TEST(ScaledDistance, IsThatOfTheScaledMesh) {
  const TriangleMesh mesh = make_cylinder({.radius = 20.0, .length = 60.0, .segments = 24});
  const Vec3 centre(3.0, -2.0, 7.0);
  constexpr double kFactor = 1.3;
  TriangleMesh larger = mesh;
  for (Vec3& v : larger.vertices) v = centre + kFactor * (v - centre);
  const MeshDistance truth(larger);
  const ScaledDistance scaled(std::make_shared<MeshDistance>(mesh), centre, kFactor);
  std::vector<Vec3> points;
  for (double t = 0.0; t < 6.0; t += 0.1) {
    points.emplace_back(28.0 * std::cos(t), 25.0 * std::sin(t), 20.0 * std::cos(2.0 * t));
  }
  std::vector<DistanceSample> a(points.size()), b(points.size());
  truth.sample(points, 10.0, a);
  scaled.sample(points, 10.0, b);
  const auto compare = [&] {
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_NEAR(b[i].distance, a[i].distance, 1e-9);
      EXPECT_LT((b[i].closest - a[i].closest).norm(), 1e-9);
      EXPECT_LT((scaled.smooth_normal(b[i]) - truth.smooth_normal(a[i])).norm(), 1e-9);
    }
  };
  compare();
  for (Vec3& p : points) p += Vec3(0.1, -0.2, 0.3);
  truth.resample(points, 10.0, a);
  scaled.resample(points, 10.0, b);
  compare();
  EXPECT_TRUE(scaled.bounding_box().isApprox(truth.bounding_box(), 1e-12));
}

}  // namespace
}  // namespace palmar::geometry
