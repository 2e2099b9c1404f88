// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/mesh/textured_mesh.h"

#include <gtest/gtest.h>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::geometry {
namespace {

/// Red rises to the right, green downwards.
RgbImage ramp(int n) {
  RgbImage image{n, n, {}};
  for (int row = 0; row < n; ++row) {
    for (int column = 0; column < n; ++column) {
      image.rgb.push_back(static_cast<std::uint8_t>(std::lround((column + 0.5) / n * 255.0)));
      image.rgb.push_back(static_cast<std::uint8_t>(std::lround((row + 0.5) / n * 255.0)));
      image.rgb.push_back(0);
    }
  }
  return image;
}

TEST(TexturedMesh, BilinearBetweenPixelCentres) {
  const RgbImage image{2, 1, {0, 0, 0, 255, 255, 255}};
  EXPECT_FLOAT_EQ(colour_at(image, {0.25F, 0.5F}).x(), 0.0F);
  EXPECT_FLOAT_EQ(colour_at(image, {0.5F, 0.5F}).x(), 0.5F);
  EXPECT_FLOAT_EQ(colour_at(image, {0.75F, 0.5F}).x(), 1.0F);
  // Beyond the border the image goes round.
  EXPECT_FLOAT_EQ(colour_at(image, {1.25F, 0.5F}).x(), 0.0F);
  EXPECT_FLOAT_EQ(colour_at(image, {-0.25F, 0.5F}).x(), 1.0F);
}

TEST(TexturedMesh, FineMeshShowsTheTextureInPlace) {
  // A square of 10 x 10 whose place in the texture is its place in space.
  const TriangleMesh square{{{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}},
                            {{0, 1, 2}, {0, 2, 3}}};
  SurfaceColours colours;
  const auto place = [&](int v) {
    const Vec3& p = square.vertices[v];
    return Eigen::Vector2f(static_cast<float>(0.1 * p.x()), static_cast<float>(0.1 * p.y()));
  };
  for (const Triangle& t : square.triangles) {
    colours.place.push_back({place(t[0]), place(t[1]), place(t[2])});
    colours.texture.push_back(0);
  }
  colours.textures.push_back(ramp(64));
  const ColouredMesh fine = coloured_mesh(square, colours, 0.7);
  EXPECT_NEAR(surface_area(fine.mesh), 100.0, 1e-9);
  for (const Triangle& t : fine.mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& a = fine.mesh.vertices[t[k]];
      const Vec3& b = fine.mesh.vertices[t[(k + 1) % 3]];
      EXPECT_LE((a - b).norm(), 0.7);
    }
  }
  for (std::size_t v = 0; v < fine.mesh.vertices.size(); ++v) {
    const Vec3& p = fine.mesh.vertices[v];
    if (p.x() < 0.1 || p.y() < 0.1 || p.x() > 9.9 || p.y() > 9.9) continue;  // goes round there
    EXPECT_NEAR(fine.colour[v].x(), 0.1 * p.x(), 0.01);
    EXPECT_NEAR(fine.colour[v].y(), 0.1 * p.y(), 0.01);
  }
}

TEST(TexturedMesh, AClosedMeshStaysClosedAndKeepsLinearVertexColours) {
  const TriangleMesh ball = make_icosphere(10.0, 1);
  SurfaceColours colours;
  for (const Vec3& v : ball.vertices) {
    colours.vertex.push_back((0.5 + 0.04 * v.array()).matrix().cast<float>());
  }
  const ColouredMesh fine = coloured_mesh(ball, colours, 1.3);
  EXPECT_NO_THROW(require_closed_manifold(fine.mesh, "ball"));
  EXPECT_NEAR(signed_volume(fine.mesh), signed_volume(ball), 1e-9);
  for (std::size_t v = 0; v < fine.mesh.vertices.size(); ++v) {
    EXPECT_NEAR(fine.colour[v].z(), 0.5 + 0.04 * fine.mesh.vertices[v].z(), 1e-5);
  }
}

TEST(TexturedMesh, RefusesWhatCannotBe) {
  const TriangleMesh ball = make_icosphere(10.0, 1);
  EXPECT_THROW(coloured_mesh(ball, {}, 1.0), UsageError);
  SurfaceColours colours;
  colours.vertex.assign(ball.vertices.size(), Srgb::Ones());
  EXPECT_THROW(coloured_mesh(ball, colours, 0.0), UsageError);
  EXPECT_THROW(coloured_mesh(ball, colours, 0.003), InputError);
}

}  // namespace
}  // namespace palmar::geometry
