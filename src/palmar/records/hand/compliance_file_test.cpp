// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/hand/compliance_file.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "palmar/formats/file.h"
#include "palmar/formats/test_files.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::records {
namespace {

hand::Hand ball_on_bone() {
  hand::Hand hand;
  hand.skin = geometry::make_icosphere(10.0, 2);
  hand.tissue = hand::Tissue{};
  for (Vec3& x : hand.skin.vertices) x.y() += 20.0;
  hand.region.assign(hand.skin.vertices.size(), hand::Region::kIndexDistal);
  hand.segment.assign(hand.skin.vertices.size(), hand::Segment::kIndexDistal);
  hand::Bone& bone = hand.bones.emplace_back();
  bone.mesh = geometry::make_icosphere(5.0, 2);
  for (Vec3& x : bone.mesh.vertices) x.y() += 20.0;
  return hand;
}

TEST(ComplianceFile, GivesBackWhatWasWrittenAndNothingElse) {
  const formats::TestFolder folder;
  const std::filesystem::path path = folder / "ball.compliance";
  const hand::Hand hand = ball_on_bone();
  const contact::SkinCompliance made =
      contact::skin_compliance(hand, contact::skin_geometry(hand.skin));
  const std::string key = compliance_key(hand);
  EXPECT_FALSE(read_compliance(path, key, hand));
  write_compliance(path, key, made);
  const auto back = read_compliance(path, key, hand);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->vertex, made.vertex);
  EXPECT_EQ(back->begin, made.begin);
  EXPECT_EQ(back->other, made.other);
  EXPECT_EQ(back->tensor, made.tensor);
  EXPECT_EQ(back->volume, made.volume);
  // Nothing but the file is left in the folder.
  int files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path()))
    ++files;
  EXPECT_EQ(files, 1);

  // Another hand's, a file cut short, a file with a byte too many.
  EXPECT_FALSE(read_compliance(path, std::string(64, '0'), hand));
  const std::string bytes = formats::read_file(path);
  for (const std::size_t length : {bytes.size() - 1, bytes.size() / 2, std::size_t{90}}) {
    formats::write_file(path, bytes.substr(0, length));
    EXPECT_FALSE(read_compliance(path, key, hand)) << length;
  }
  formats::write_file(path, bytes + "x");
  EXPECT_FALSE(read_compliance(path, key, hand));
}

TEST(ComplianceFile, KeyIsOfShapeAndOptionsNotOfTissue) {
  hand::Hand hand = ball_on_bone();
  const std::string key = compliance_key(hand);
  EXPECT_EQ(key.size(), 64U);
  hand.tissue.region[0].on_bone.nominal.g0 = 0.5;
  hand.name = "another name";
  EXPECT_EQ(compliance_key(hand), key);
  hand.bones[0].mesh.vertices[3].x() += 1e-9;
  EXPECT_NE(compliance_key(hand), key);
  contact::SkinComplianceOptions finer;
  finer.mesh.finger_edge = 1.5;
  EXPECT_NE(compliance_key(ball_on_bone(), finer), key);
}

}  // namespace
}  // namespace palmar::records
