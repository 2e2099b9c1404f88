// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/mri/bones/bone_plausibility.h"

#include <gmock/gmock.h>

#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::capture {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// A rod along y from `from` to `to`, mm.
geometry::TriangleMesh rod(double from, double to) {
  geometry::TriangleMesh mesh = geometry::make_box({8.0, to - from, 8.0}, 8);
  for (Vec3& v : mesh.vertices) v.y() += 0.5 * (from + to);
  return mesh;
}

hand::Bone named(const std::string& name, geometry::TriangleMesh mesh) {
  hand::Bone bone;
  bone.name = name;
  bone.mesh = std::move(mesh);
  return bone;
}

hand::Hand model() {
  hand::Hand hand;
  hand.bones.resize(4);
  hand.bones[0].name = "index_metacarpal";
  hand.bones[0].mesh = rod(0.0, 70.0);
  hand.bones[1].name = "index_proximal_phalanx";
  hand.bones[1].mesh = rod(72.0, 112.0);
  hand.bones[2].name = "index_middle_phalanx";
  hand.bones[2].mesh = rod(114.0, 138.0);
  hand.bones[3].name = "index_distal_phalanx";
  hand.bones[3].mesh = rod(140.0, 158.0);
  return hand;
}

/// The model's bones, all larger by a fifth: a larger hand.
ScanSurfaces larger_hand() {
  ScanSurfaces surfaces;
  for (const hand::Bone& bone : model().bones) {
    surfaces.bones.push_back({bone.name, bone.mesh, false});
    for (Vec3& v : surfaces.bones.back().mesh.vertices) v *= 1.2;
  }
  return surfaces;
}

TEST(BonePlausibility, AnotherSizeIsFine) {
  EXPECT_THAT(doubtful_bones(larger_hand(), model()), IsEmpty());
  EXPECT_THAT(doubtful_bones(ScanSurfaces{}, model()), IsEmpty());
}

TEST(BonePlausibility, HalfABoneIsReported) {
  ScanSurfaces surfaces = larger_hand();
  surfaces.bones[1].mesh = rod(1.2 * 72.0, 1.2 * 92.0);
  EXPECT_THAT(doubtful_bones(surfaces, model()),
              ElementsAre("index_proximal_phalanx is 24 mm long, where about 48 mm are expected",
                          "index_proximal_phalanx and index_middle_phalanx are 26 mm apart"));
  surfaces.bones[1].is_cut = true;  // by the image: reported elsewhere
  EXPECT_EQ(doubtful_bones(surfaces, model()).size(), 1U);
  surfaces.bones.erase(surfaces.bones.begin() + 1);
  EXPECT_THAT(doubtful_bones(surfaces, model()), IsEmpty());
}

TEST(BonePlausibility, AScaphoidIsAsLongAsPeoplesAreWhateverTheModelsIs) {
  hand::Hand short_one = model();
  short_one.bones.push_back(named("middle_metacarpal", rod(0.0, 64.6)));
  short_one.bones.push_back(named("scaphoid", rod(-20.0, -4.0)));
  ScanSurfaces surfaces;
  for (const hand::Bone& bone : short_one.bones)
    surfaces.bones.push_back({bone.name, bone.mesh, false});
  geometry::TriangleMesh& scaphoid = surfaces.bones.back().mesh;
  for (const double length : {24.5, 26.0, 27.6}) {  // women, all, men
    scaphoid = rod(0.0, length);
    EXPECT_THAT(doubtful_bones(surfaces, short_one), IsEmpty()) << length;
  }
  scaphoid = rod(0.0, 46.0);  // with the lunate and more
  EXPECT_THAT(doubtful_bones(surfaces, short_one),
              ElementsAre("scaphoid is 46 mm long, where about 26 mm are expected"));
  scaphoid = rod(0.0, 12.0);  // half of it
  EXPECT_THAT(doubtful_bones(surfaces, short_one),
              ElementsAre("scaphoid is 12 mm long, where about 26 mm are expected"));
}

TEST(BonePlausibility, OfTheForearmAnyLengthWillDo) {
  hand::Hand stump = model();
  stump.bones.push_back(named("radius", rod(-60.0, -40.0)));
  ScanSurfaces surfaces = larger_hand();
  surfaces.bones.push_back({"radius", rod(-150.0, -48.0), false});
  EXPECT_THAT(doubtful_bones(surfaces, stump), IsEmpty());
}

}  // namespace
}  // namespace palmar::capture
