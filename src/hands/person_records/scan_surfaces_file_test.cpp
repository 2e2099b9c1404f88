// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_records/scan_surfaces_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "hands/person_records/bone_label_file.h"
#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/test_files.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::person_records {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

geometry::TriangleMesh ball(const Vec3& centre) {
  geometry::TriangleMesh mesh = geometry::make_icosphere(5.0, 2);
  for (Vec3& v : mesh.vertices) v += centre;
  return mesh;
}

capture::ScanSurfaces two_bones() {
  capture::ScanSurfaces surfaces;
  surfaces.skin = geometry::make_icosphere(40.0, 3);
  surfaces.bones = {{"index_distal_phalanx", ball({10, 0, 0}), false},
                    {"index_middle_phalanx", ball({-10, 0, 0}), false},
                    {"", ball({0, 20, 0}), true}};
  surfaces.markers = {{1.0, 2.0, 3.0}};
  surfaces.side = hand::Side::kLeft;
  surfaces.bone_threshold = 54.0;
  surfaces.notes = {"One bone has no name."};
  return surfaces;
}

TEST(ScanSurfacesFile, GivesBackWhatWasWritten) {
  const formats::TestFolder folder;
  const std::string path = (folder / "scan").string();
  EXPECT_EQ(key_of_scan_surfaces(path), "");
  write_scan_surfaces(path, two_bones(), "abc");
  EXPECT_EQ(key_of_scan_surfaces(path), "abc");
  const capture::ScanSurfaces back = read_scan_surfaces(path);
  ASSERT_EQ(back.bones.size(), 3U);
  EXPECT_EQ(back.bones[1].name, "index_middle_phalanx");
  EXPECT_EQ(back.bones[2].name, "");
  EXPECT_TRUE(back.bones[2].is_cut);
  EXPECT_EQ(back.bones[0].mesh.vertices, two_bones().bones[0].mesh.vertices);
  EXPECT_EQ(back.skin.triangles, two_bones().skin.triangles);
  EXPECT_EQ(back.markers, two_bones().markers);
  EXPECT_EQ(back.side, hand::Side::kLeft);
  EXPECT_EQ(back.bone_threshold, 54.0);
  EXPECT_EQ(back.notes, two_bones().notes);
}

TEST(ScanSurfacesFile, NamesTheFileThatIsBroken) {
  const formats::TestFolder folder;
  const std::string path = (folder / "scan").string();
  write_scan_surfaces(path, two_bones(), "abc");
  fs::remove(fs::path(path) / "bones" / "index_distal_phalanx.ply");
  EXPECT_THAT(formats::message_of<InputError>([&] { read_scan_surfaces(path); }),
              HasSubstr("index_distal_phalanx.ply"));
  formats::write_file(fs::path(path) / "scan.json", "{\"key\": 3");
  EXPECT_EQ(key_of_scan_surfaces(path), "");
  EXPECT_THROW(read_scan_surfaces(path), InputError);
}

hand::Hand model() {
  hand::Hand hand;
  hand.bones = {{"index_middle_phalanx", {}, false, {}}, {"index_distal_phalanx", {}, false, {}}};
  return hand;
}

std::string failure(const std::vector<hand::BoneLabel>& labels) {
  capture::ScanSurfaces surfaces = two_bones();
  return formats::message_of<InputError>(
      [&] { capture::apply_bone_labels(surfaces, labels, model()); });
}

TEST(BoneLabels, TakeTheNameFromTheBoneThatHadIt) {
  const formats::TestFolder folder;
  formats::write_file((folder / "labels.csv").string(),
                      "name,x_mm,y_mm,z_mm\nindex_distal_phalanx,0,20,1\n");
  capture::ScanSurfaces surfaces = two_bones();
  capture::apply_bone_labels(surfaces, read_bone_labels((folder / "labels.csv").string()), model());
  EXPECT_EQ(surfaces.bones[0].name, "");
  EXPECT_EQ(surfaces.bones[1].name, "index_middle_phalanx");
  EXPECT_EQ(surfaces.bones[2].name, "index_distal_phalanx");
}

TEST(BoneLabels, SayWhatIsWrongWithThem) {
  const std::string name = "index_distal_phalanx";
  EXPECT_THAT(failure({{"index_distal_phalank", {0, 20, 0}, "l.csv:2"}}),
              HasSubstr("l.csv:2: \"index_distal_phalank\" is no bone of the hand; did you mean "
                        "index_distal_phalanx?"));
  EXPECT_THAT(failure({{name, {0, -20, 0}, "l.csv:2"}}),
              HasSubstr("l.csv:2: no bone was found within 3 mm of (0.0, -20.0, 0.0) mm"));
  EXPECT_THAT(failure({{name, {0, 20, 0}, "l.csv:2"}, {name, {10, 0, 0}, "l.csv:3"}}),
              HasSubstr("l.csv:3: index_distal_phalanx appears twice, first in l.csv:2"));
  EXPECT_THAT(
      failure({{name, {0, 20, 0}, "l.csv:2"}, {"index_middle_phalanx", {0, 21, 0}, "l.csv:3"}}),
      HasSubstr("are on the same bone"));
}

TEST(BoneLabels, AreReadWithTheirLine) {
  const formats::TestFolder folder;
  formats::write_file((folder / "l.csv").string(), "name,x_mm,y_mm\nlunate,1,2\n");
  EXPECT_THAT(
      formats::message_of<InputError>([&] { read_bone_labels((folder / "l.csv").string()); }),
      HasSubstr("l.csv:1: has no column z_mm"));
}

}  // namespace
}  // namespace palmar::person_records
