// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/mri/bones/bone_outline.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hands/capture/mri/bones/find_surfaces.h"
#include "palmar/core/error.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::capture {
namespace {

TEST(OutlineOf, ReportsAnEllipsoidsAxisAndLength) {
  geometry::TriangleMesh mesh = geometry::make_icosphere(1.0, 3);
  for (Vec3& v : mesh.vertices) v = Vec3(4.0 * v.x() + 10.0, 20.0 * v.y(), 5.0 * v.z());
  const BoneOutline outline = outline_of(mesh);
  EXPECT_NEAR(outline.length, 40.0, 0.3);  // mm; the icosphere's corners
  EXPECT_NEAR(outline.width, 9.0, 0.2);
  EXPECT_NEAR(std::abs(outline.axis.y()), 1.0, 1e-6);
  EXPECT_NEAR((outline.centre - Vec3(10.0, 0.0, 0.0)).norm(), 0.0, 1e-6);
}

TEST(FindSurfaces, RefusesAnImageThatIsTooCoarseOrShowsNoHand) {
  imaging::Volume image;
  image.grid.size = {20, 20, 20};
  image.grid.spacing = {3.0, 3.0, 3.0};
  image.value.assign(image.grid.count(), 0.0F);
  try {
    find_surfaces(image, "series 4", hand::Hand{});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("series 4: voxels of 3.00 x 3.00 x 3.00 mm"));
  }
  image.grid.spacing = {1.0, 1.0, 1.0};
  EXPECT_THROW(find_surfaces(image, "series 4", hand::Hand{}), InputError);
}

}  // namespace
}  // namespace palmar::capture
