// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/imaging/iso_surface.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"

namespace palmar::imaging {
namespace {

const double kPi = std::acos(-1.0);

Volume image_of_function(const VolumeGrid& grid, double (*f)(const Vec3&)) {
  Volume image{grid, {}};
  for (int k = 0; k < grid.size[2]; ++k) {
    for (int j = 0; j < grid.size[1]; ++j) {
      for (int i = 0; i < grid.size[0]; ++i) {
        image.value.push_back(static_cast<float>(f(grid.to_patient(Vec3(i, j, k)))));
      }
    }
  }
  return image;
}

VolumeGrid fine_grid() {
  VolumeGrid grid;
  grid.size = {44, 54, 36};
  grid.spacing = {0.5, 0.4, 0.6};
  grid.origin = {-10.7, -10.6, -10.5};
  return grid;
}

TEST(IsoSurface, EveryCaseOfACellGivesAClosedManifold) {
  for (int inside = 1; inside < 256; ++inside) {
    Volume image;
    image.grid.size = {2, 2, 2};
    for (int c = 0; c < 8; ++c) image.value.push_back(((inside >> c) & 1) != 0 ? 1.0F : 0.0F);
    const geometry::TriangleMesh mesh = iso_surface(image, 0.5);
    const geometry::TopologyReport report = geometry::examine_topology(mesh);
    EXPECT_TRUE(report.is_closed && report.is_two_manifold && report.is_oriented) << inside;
    EXPECT_GT(geometry::signed_volume(mesh), 0.0) << inside;
  }
}

TEST(IsoSurface, SphereHasItsAreaAndVolume) {
  const geometry::TriangleMesh mesh = iso_surface(
      image_of_function(fine_grid(), [](const Vec3& p) { return 8.0 - p.norm(); }), 0.0);
  // Inscribed polyhedra lack a share of about (edge / radius)^2 / 8.
  EXPECT_NEAR(geometry::signed_volume(mesh) / (4.0 / 3.0 * kPi * 512.0), 1.0, 0.003);
  EXPECT_NEAR(geometry::surface_area(mesh) / (4.0 * kPi * 64.0), 1.0, 0.004);
  EXPECT_EQ(geometry::examine_topology(mesh).euler_number, 2);
}

TEST(IsoSurface, TorusHasItsHoleAndPappusVolume) {
  const geometry::TriangleMesh mesh =
      iso_surface(image_of_function(fine_grid(),
                                    [](const Vec3& p) {
                                      const double ring = std::hypot(p.x(), p.y()) - 6.0;
                                      return 2.5 - std::hypot(ring, p.z());
                                    }),
                  0.0);
  EXPECT_EQ(geometry::examine_topology(mesh).euler_number, 0);
  EXPECT_NEAR(geometry::signed_volume(mesh) / (2.0 * kPi * kPi * 6.0 * 6.25), 1.0, 0.01);
}

TEST(IsoSurface, BorderIsClosedOnTheVoxelsOuterFacesAndMirroredAxesStayOutward) {
  Volume image;
  image.grid.size = {3, 4, 5};
  image.grid.spacing = {1.0, 2.0, 0.5};
  image.grid.axes.col(2) *= -1.0;
  image.value.assign(60, 7.0F);
  const geometry::TriangleMesh mesh = iso_surface(image, 1.0);
  const Box3 box = geometry::bounding_box(mesh);
  EXPECT_NEAR((box.sizes() - Vec3(3.0, 8.0, 2.5)).norm(), 0.0, 1e-12);  // mm
  EXPECT_GT(geometry::signed_volume(mesh), 0.0);
}

TEST(IsoSurface, NothingBrightGivesNoSurfaceAndAWrongSizeIsRefused) {
  Volume image;
  image.grid.size = {2, 2, 2};
  image.value.assign(8, 0.0F);
  EXPECT_TRUE(iso_surface(image, 1.0).triangles.empty());
  image.value.pop_back();
  EXPECT_THROW(iso_surface(image, 1.0), UsageError);
}

}  // namespace
}  // namespace palmar::imaging
