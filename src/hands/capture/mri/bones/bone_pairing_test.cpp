// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/mri/bones/bone_pairing.h"

#include <gmock/gmock.h>

#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::capture {
namespace {

using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;

constexpr double kTip = 162.6;  // skin of the fingertip, 4.6 mm beyond the last bone

/// A box along y from `from` to `to`, mm.
geometry::TriangleMesh bar(double from, double to, double wide) {
  geometry::TriangleMesh mesh = geometry::make_box({wide, to - from, wide}, 4);
  for (Vec3& v : mesh.vertices) v.y() += 0.5 * (from + to);
  return mesh;
}

/// One finger, straight, of four bones.
hand::Hand one_finger() {
  hand::Hand hand;
  hand.bones.resize(4);
  hand.bones[0].name = "index_metacarpal";
  hand.bones[0].mesh = bar(0.0, 70.0, 9.0);
  hand.bones[1].name = "index_proximal_phalanx";
  hand.bones[1].mesh = bar(72.0, 112.0, 9.0);
  hand.bones[2].name = "index_middle_phalanx";
  hand.bones[2].mesh = bar(114.0, 138.0, 8.0);
  hand.bones[3].name = "index_distal_phalanx";
  hand.bones[3].mesh = bar(140.0, 158.0, 7.0);
  return hand;
}

class OneFinger : public ::testing::Test {
 protected:
  /// Bright tissue between two ends along the finger, darkly enclosed; its number.
  MarrowRegion& marrow(double from, double to, double aside = 0.0) {
    MarrowRegion region;
    region.regions = {static_cast<std::int32_t>(candidates_.size())};
    for (double y = from + 0.5; y < to; y += 1.0) {
      for (int x = -2; x <= 2; ++x) {
        for (int z = -2; z <= 2; ++z) region.voxels.emplace_back(aside + x, y, z);
      }
    }
    region.volume = static_cast<double>(region.voxels.size());
    region.level = 80.0;
    region.shell = 24.0;
    candidates_.push_back(region);
    return candidates_.back();
  }

  /// What is found for each bone of the model: regions it holds.
  std::vector<std::vector<std::int32_t>> pair(double longer = 1.0) {
    const ScanLevels levels{.dark = 0.0, .bright = 100.0};
    const hand::Hand model = one_finger();
    std::vector<std::vector<BoneOutline>> expected(1);
    for (const hand::Bone& bone : model.bones) expected.front().push_back(outline_of(bone.mesh));
    expected.push_back(expected.front());
    for (BoneOutline& bone : expected.back()) {
      bone.centre.y() *= longer;
      bone.length *= longer;
    }
    geometry::TriangleMesh skin = bar(-10.0, longer * kTip, 20.0);
    const BonePairing pairing =
        pair_bones(bone_hypotheses(candidates_, levels, 100.0), levels, skin, model, expected);
    std::vector<std::vector<std::int32_t>> found;
    for (const int f : pairing.found) {
      found.emplace_back();
      if (f >= 0) found.back() = pairing.regions[f].regions;
    }
    return found;
  }

  std::vector<MarrowRegion> candidates_;
};

TEST_F(OneFinger, PartsOfAShaftAreOneBoneAndTheLastBoneKeepsItsName) {
  marrow(1.0, 69.0);
  marrow(73.0, 111.0);
  marrow(115.0, 123.0);  // the middle phalanx; its marrow is too thin to be seen in the middle
  marrow(129.0, 137.0);
  marrow(141.0, 157.0);
  const auto found = pair();
  EXPECT_THAT(found[0], ElementsAre(0));
  EXPECT_THAT(found[1], ElementsAre(1));
  EXPECT_THAT(found[2], UnorderedElementsAre(2, 3));
  EXPECT_THAT(found[3], ElementsAre(4));
}

TEST_F(OneFinger, ThreePartsMakeABone) {
  marrow(1.0, 69.0);
  marrow(73.0, 84.0);
  marrow(89.0, 95.0);
  marrow(100.0, 111.0);
  marrow(115.0, 137.0);
  marrow(141.0, 157.0);
  const auto found = pair();
  EXPECT_THAT(found[1], UnorderedElementsAre(1, 2, 3));
  EXPECT_THAT(found[2], ElementsAre(4));
  EXPECT_THAT(found[3], ElementsAre(5));
}

TEST_F(OneFinger, HalfOfABoneIsntTheLastOne) {
  marrow(1.0, 69.0);
  marrow(73.0, 111.0);
  marrow(115.0, 123.0);
  marrow(129.0, 137.0);  // nothing is seen of the last phalanx: this ends 26 mm from the fingertip
  EXPECT_THAT(pair()[3], ElementsAre());
}

TEST_F(OneFinger, FatLiesOpenOrBendsRoundSomething) {
  marrow(1.0, 69.0);
  marrow(73.0, 111.0);
  marrow(115.0, 137.0);
  marrow(142.0, 153.0);                  // the bone, of which a part is seen
  marrow(140.5, 157.5, 3.0).open = 0.3;  // nearer to its size and place than the bone
  marrow(140.5, 157.5, -3.0).convexity = 0.5;
  EXPECT_THAT(pair()[3], ElementsAre(3));
}

TEST_F(OneFinger, TheBetterGuessOfTheHandsLengthIsTaken) {
  const double longer = 1.25;
  marrow(longer * 0.0 + 1.0, longer * 70.0 - 1.0);
  marrow(longer * 72.0 + 1.0, longer * 112.0 - 1.0);
  marrow(longer * 114.0 + 1.0, longer * 138.0 - 1.0);
  marrow(longer * 140.0 + 1.0, longer * 158.0 - 1.0);
  const auto found = pair(longer);
  for (std::size_t b = 0; b < 4; ++b) EXPECT_THAT(found[b], ElementsAre(static_cast<int>(b)));
}

}  // namespace
}  // namespace palmar::capture
