// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/picture/display_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::report {
namespace {

TEST(DisplayMesh, StaysOnTheSurfaceBelowTheLimit) {
  const geometry::TriangleMesh ball = geometry::make_icosphere(50.0, 6);  // 81 920 triangles
  std::vector<double> value(ball.vertices.size(), 0.0);
  value[1234] = 0.7;
  const DisplayMesh coarse = display_mesh(ball, value, 20000);
  EXPECT_LE(coarse.mesh.triangle_count(), 20000);
  EXPECT_GT(coarse.mesh.triangle_count(), 5000);
  ASSERT_EQ(coarse.value.size(), coarse.mesh.vertices.size());
  EXPECT_EQ(*std::max_element(coarse.value.begin(), coarse.value.end()), 0.7);
  for (const Vec3& v : coarse.mesh.vertices) EXPECT_NEAR(v.norm(), 50.0, 0.1);
}

TEST(DisplayMesh, SmallMeshesComeBackAsTheyAre) {
  const geometry::TriangleMesh box = geometry::make_box({1, 2, 3}, 2);
  const DisplayMesh same = display_mesh(box, std::vector<double>(box.vertices.size(), 1.0), 1000);
  EXPECT_EQ(same.mesh.vertices, box.vertices);
  EXPECT_EQ(same.mesh.triangles, box.triangles);
}

}  // namespace
}  // namespace palmar::report
