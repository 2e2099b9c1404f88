// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/mesh/cluster_vertices.h"

#include <gtest/gtest.h>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::geometry {
namespace {

TEST(ClusterVertices, ABallStaysABallWithFarFewerTriangles) {
  const double radius = 8.0, spacing = 1.2;
  const TriangleMesh fine = make_icosphere(radius, 5);  // edges of 0.3 mm
  const TriangleMesh coarse = cluster_vertices(fine, spacing);
  EXPECT_LT(coarse.triangle_count(), fine.triangle_count() / 5);
  double mean = 0.0;
  for (const Vec3& v : coarse.vertices) {
    EXPECT_NEAR(v.norm(), radius, 0.1);
    mean += v.norm();
  }
  mean /= coarse.vertex_count();
  // The mean of points on a ball lies inside: by the variance across over twice the radius.
  EXPECT_NEAR(mean, radius - spacing * spacing / (12.0 * radius), 0.02);
  EXPECT_NEAR(surface_area(coarse), surface_area(fine), 0.02 * surface_area(fine));
}

TEST(ClusterVertices, SmallSpacingLeavesTheMesh) {
  const TriangleMesh ball = make_icosphere(10.0, 2);
  EXPECT_EQ(cluster_vertices(ball, 0.01).triangle_count(), ball.triangle_count());
  EXPECT_THROW(cluster_vertices(ball, 0.0), UsageError);
}

}  // namespace
}  // namespace palmar::geometry
