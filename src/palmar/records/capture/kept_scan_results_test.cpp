// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/capture/kept_scan_results.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "palmar/formats/file.h"
#include "palmar/formats/test_files.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar {
namespace {

ScanSurfaces one_bone() {
  ScanSurfaces surfaces;
  surfaces.skin = make_icosphere(40.0, 2);
  surfaces.bones = {{"index_distal_phalanx", make_icosphere(5.0, 1), false}};
  surfaces.markers = {{1.0, 2.0, 3.0}};
  return surfaces;
}

TEST(KeptScanResults, DigestReportsWhatLaterStepsUse) {
  const std::string digest = digest_of(one_bone());
  EXPECT_EQ(digest_of(one_bone()), digest);
  ScanSurfaces other = one_bone();
  other.notes = {"told to people only"};
  EXPECT_EQ(digest_of(other), digest);
  other = one_bone();
  other.bones.front().mesh.vertices.front().x() += 1e-9;
  EXPECT_NE(digest_of(other), digest);
  other = one_bone();
  other.bones.front().name = "index_middle_phalanx";
  EXPECT_NE(digest_of(other), digest);
  other = one_bone();
  other.side = Side::kLeft;
  EXPECT_NE(digest_of(other), digest);
  other = one_bone();
  other.markers.clear();
  EXPECT_NE(digest_of(other), digest);
  other = one_bone();
  std::swap(other.skin.triangles[0][0], other.skin.triangles[0][1]);
  EXPECT_NE(digest_of(other), digest);
}

TEST(KeptScanResults, MotionsComeBackBitForBit) {
  const TestFolder folder;
  const std::string path = (folder / "grasp").string();
  BoneMotion motion;
  motion.bone = motion.counterpart = "capitate";
  motion.posture_from_reference.rotation = Quat(Eigen::AngleAxisd(0.1, Vec3(1, 2, 3).normalized()));
  motion.posture_from_reference.translation = Vec3(1.0 / 3.0, -1e-17, 5e9);
  motion.fit.mean = 0.1;
  motion.fit.iterations = 7;
  motion.image.emplace();
  motion.image->correlation = 0.9;
  motion.image->turn_error = std::numeric_limits<double>::infinity();
  motion.is_cut_out = false;
  keep_bone_motions(path, "key", {motion});
  EXPECT_FALSE(kept_bone_motions(path, "another").has_value());
  const auto back = kept_bone_motions(path, "key");
  ASSERT_TRUE(back.has_value());
  ASSERT_EQ(back->size(), 1U);
  const BoneMotion& one = back->front();
  EXPECT_EQ(one.bone, "capitate");
  EXPECT_EQ(one.posture_from_reference.rotation.coeffs(),
            motion.posture_from_reference.rotation.coeffs());
  EXPECT_EQ(one.posture_from_reference.translation, motion.posture_from_reference.translation);
  EXPECT_EQ(one.fit.mean, 0.1);
  EXPECT_EQ(one.fit.iterations, 7);
  ASSERT_TRUE(one.image.has_value());
  EXPECT_EQ(one.image->correlation, 0.9);
  EXPECT_FALSE(std::isfinite(one.image->turn_error));
  EXPECT_FALSE(one.is_cut_out);
}

TEST(KeptScanResults, WhatIsDamagedIsNotTakenUp) {
  const TestFolder folder;
  const std::string path = (folder / "grasp").string();
  EXPECT_FALSE(kept_bone_motions(path, "").has_value());
  EXPECT_FALSE(kept_scanned_hand(path, "").has_value());
  keep_bone_motions(path, "key", {BoneMotion{}});
  const std::string file = path + "/motions.json";
  write_file(file, read_file(file).substr(0, 60));
  EXPECT_FALSE(kept_bone_motions(path, "key").has_value());
  write_file(file, "{\"key\": \"key\", \"motions\": [{}]}");
  EXPECT_FALSE(kept_bone_motions(path, "key").has_value());
}

}  // namespace
}  // namespace palmar
