// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/mri/bones/image_edge.h"

#include <gmock/gmock.h>

#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::capture {
namespace {

geometry::TriangleMesh moved_edge(geometry::TriangleMesh mesh, const Vec3& by) {
  for (Vec3& v : mesh.vertices) v += by;
  return mesh;
}

/// A hand of three bones in a skin from y = -40 to 40 mm, in voxels of 1 mm round the origin.
ScanSurfaces three_bones() {
  ScanSurfaces surfaces;
  surfaces.skin = geometry::make_icosphere(40.0, 4);
  surfaces.bones = {
      {"middle_distal_phalanx", moved_edge(geometry::make_icosphere(4.0, 2), {0, 30, 0}), false},
      {"capitate", geometry::make_icosphere(8.0, 2), false},
      {"radius", moved_edge(geometry::make_icosphere(5.0, 2), {0, -30, 0}), false}};
  return surfaces;
}

imaging::VolumeGrid grid_of(double top, double bottom) {
  imaging::VolumeGrid grid;
  grid.size = {120, static_cast<int>(top - bottom) + 1, 120};
  grid.origin = Vec3(-60.0, bottom, -60.0);
  return grid;
}

TEST(ImageEdge, AWholeHandIsNotCut) {
  ScanSurfaces surfaces = three_bones();
  mark_cut_fingers(surfaces, grid_of(50.0, -50.0));
  EXPECT_THAT(cut_bones_of_fingers(surfaces), testing::IsEmpty());
  EXPECT_FALSE(surfaces.bones[2].is_cut);
}

TEST(ImageEdge, AFingertipAtTheEdgeCutsItsLastBone) {
  ScanSurfaces surfaces = three_bones();
  mark_cut_fingers(surfaces, grid_of(40.0, -50.0));  // the bone ends at 34 mm
  EXPECT_THAT(cut_bones_of_fingers(surfaces), testing::ElementsAre("middle_distal_phalanx"));
}

TEST(ImageEdge, TheForearmIsNoFinger) {
  ScanSurfaces surfaces = three_bones();
  mark_cut_fingers(surfaces, grid_of(50.0, -40.0));
  EXPECT_THAT(cut_bones_of_fingers(surfaces), testing::IsEmpty());
  EXPECT_TRUE(surfaces.bones[2].is_cut);
}

}  // namespace
}  // namespace palmar::capture
