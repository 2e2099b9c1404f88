// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/motion/marker_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/motion/c3d_test_file.h"

namespace palmar::formats {
namespace {

using ::testing::HasSubstr;

class MarkerFileTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::temp_directory_path() / ("palmar_markers_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  MarkerRecording read(const std::string& bytes, std::optional<geometry::LengthUnit> unit = {}) {
    const std::string path = (folder_ / "take.csv").string();
    write_file(path, bytes);
    return read_markers(path, unit);
  }
  std::string message(const std::string& bytes) {
    try {
      read(bytes);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  std::filesystem::path folder_;
};

TEST_F(MarkerFileTest, CsvInSeveralUnitsWithMissingMarkers) {
  const MarkerRecording read_back = read(
      "frame,time_s,a_x_mm,a_y_mm,a_z_mm,b_X_m,b_Y_m,b_Z_m\n"
      "7,0.5,1,2,3,0.1,0.2,0.3\n"
      "8,0.6,,,,nan,nan,nan\n");
  EXPECT_EQ(read_back.labels, (std::vector<std::string>{"a", "b"}));
  ASSERT_EQ(read_back.frames.size(), 2U);
  EXPECT_EQ(read_back.frames[0].number, 7);
  EXPECT_EQ(read_back.frames[1].time, 0.6);
  EXPECT_EQ(*read_back.frames[0].position[0], Vec3(1, 2, 3));
  EXPECT_LT((*read_back.frames[0].position[1] - Vec3(100, 200, 300)).norm(), 1e-12);
  EXPECT_FALSE(read_back.frames[1].position[0]);
  EXPECT_FALSE(read_back.frames[1].position[1]);
}

TEST_F(MarkerFileTest, TheUserMayGiveTheUnit) {
  EXPECT_THAT(message("a_x,a_y,a_z\n1,2,3\n"), HasSubstr("has no unit"));
  EXPECT_EQ(*read("a_x,a_y,a_z\n1,2,3\n", geometry::LengthUnit::kCentimetre).frames[0].position[0],
            Vec3(10, 20, 30));
}

TEST_F(MarkerFileTest, AC3dFileIsKnownByItsContent) {
  C3dTestFile file;
  file.labels = {"a", "b"};
  file.frames = {{{1, 2, 3}, {4, 5, 6}}};
  const MarkerRecording read_back = read(file.bytes());
  EXPECT_THAT(read_back.format, HasSubstr("C3D"));
  EXPECT_EQ(*read_back.frames[0].position[1], Vec3(4, 5, 6));
}

TEST_F(MarkerFileTest, MistakesAreNamed) {
  EXPECT_THAT(message("a_x_mm,a_y_mm\n1,2\n"), HasSubstr("marker \"a\" has no column _z"));
  EXPECT_THAT(message("a_x_mm,a_x_cm,a_y_mm,a_z_mm\n1,2,3,4\n"), HasSubstr("say the same"));
  EXPECT_THAT(message("a_x_mm,a_y_mm,a_z_mm\n1,2,\n"), HasSubstr("take.csv:2"));
  EXPECT_THAT(message("a_x_mm,a_y_mm,a_z_mm\n1,2,\n"), HasSubstr("2 of 3 coordinates"));
  EXPECT_THAT(message("a_x_mm,a_y_mm,a_z_mm\n1,2,x\n"), HasSubstr("a_z_mm is \"x\""));
  EXPECT_THAT(message("a_x_mm,a_y_mm,a_z_mm\n"), HasSubstr("no frames"));
  EXPECT_THAT(message("time_s,width\n1,2\n"), HasSubstr("no markers"));
  EXPECT_THAT(message("frame,a_x_mm,a_y_mm,a_z_mm\n1.5,1,2,3\n"), HasSubstr("whole number"));
  EXPECT_THAT(message(std::string("\x00\x01\x02\x03", 4)), HasSubstr("C3D and CSV"));
}

}  // namespace
}  // namespace palmar::formats
