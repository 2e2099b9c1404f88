// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/images/dicom_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>

#include "hands/images/dicom.h"
#include "hands/images/dicom_test_files.h"
#include "palmar/core/error.h"
#include "palmar/formats/test_files.h"

namespace palmar::images {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// Two frames of 4 x 3 pixels with the place of the first, without functional groups; slices are
/// transversal, the first at z = 0.
DicomTestFile old_style_file() {
  DicomTestFile file = DicomTestFile::slice(4, 3, 0.0);
  std::vector<int> pixels;
  for (int p = 0; p < 24; ++p) pixels.push_back(p);
  file.pixels(pixels);
  file.text(0x00280008, "IS", "2");
  return file;
}

/// One frame at z, mm, with this echo time in its functional groups.
DicomTestFile frame_of_echo(double z, double echo_time) {
  DicomTestFile position, echo, frame;
  position.text(0x00200032, "DS", "-10\\20\\" + std::to_string(z));
  const auto bytes = std::bit_cast<std::array<char, 8>>(echo_time);
  echo.element[0x00189082] = {"FD", std::string(bytes.data(), bytes.size())};
  frame.sequence(0x00209113, {position});
  frame.sequence(0x00189114, {echo});
  return frame;
}

std::string message_for(const DicomTestFile& file) {
  const formats::TestFolder folder;
  file.write(folder / "one.dcm");
  return formats::message_of<InputError>([&] { read_image(folder / "one.dcm"); });
}

TEST(DicomFrames, OneFileIsOneSeriesWithoutItsFolder) {
  const formats::TestFolder folder;
  multi_frame_file(4, 3, {4.0, 0.0, 2.0}).write(folder / "s/one.dcm");
  write_test_series(folder / "s");  // isn't meant
  const auto series = find_dicom_series(folder / "s/one.dcm");
  ASSERT_EQ(series.size(), 1U);
  EXPECT_EQ(series[0].slices, 3);
  EXPECT_THAT(series[0].files, ElementsAre(folder / "s/one.dcm"));
  const ImageFile file = read_image(folder / "s/one.dcm");
  EXPECT_EQ(file.description, "t1 coronal");
  EXPECT_EQ(file.image.grid.size, (std::array<int, 3>{4, 3, 3}));
  EXPECT_EQ(file.image.value[0], 201.0F);  // the frame at z = 0 is the second: 2 * 100 + 1
  EXPECT_EQ(read_image(folder / "s/one.dcm", {7, ""}).image.value, file.image.value);
  EXPECT_THAT(
      formats::message_of<InputError>([&] {
        read_image(folder / "s/one.dcm", {8, ""});
      }),
      HasSubstr("one.dcm: no series with number 8; there are:\n  7 \"t1 coronal\", 3 slices"));
}

TEST(DicomFrames, EnhancedFilesOfOneFrameEachMakeASeries) {
  const formats::TestFolder folder;
  for (int k = 0; k < 3; ++k) {
    multi_frame_file(4, 3, {1.5 * k}).write(folder / ("s/" + std::to_string(k) + ".dcm"));
  }
  const imaging::Volume image = read_image(folder / "s").image;
  EXPECT_EQ(image.grid.size, (std::array<int, 3>{4, 3, 3}));
  EXPECT_LT((image.grid.spacing - Vec3(0.25, 0.5, 1.5)).norm(), 1e-12);
  EXPECT_EQ(image.value[11], 23.0F);
  EXPECT_THAT(formats::message_of<InputError>([&] { read_image(folder / "s/1.dcm"); }),
              HasSubstr("s/1.dcm: is one DICOM file of one slice; the folder with its series is"));
}

TEST(DicomFrames, AnImageInTwoFilesIsReadFromTheirFolder) {
  const formats::TestFolder folder;
  for (const int part : {0, 1}) {
    DicomTestFile file = multi_frame_file(4, 3, {2.0 * part, 2.0 * part + 1.0});
    file.number(0x00209162, part + 1);
    file.number(0x00209163, 2);
    file.write(folder / ("s/" + std::to_string(part)));
  }
  EXPECT_EQ(read_image(folder / "s").image.grid.size, (std::array<int, 3>{4, 3, 4}));
  EXPECT_THAT(formats::message_of<InputError>([&] { read_image(folder / "s/1"); }),
              HasSubstr("s/1: is one of 2 files of one image (In-concatenation Total Number "
                        "(0020,9163)); the folder with all of them is required"));
}

TEST(DicomFrames, SideOfTheHandComesFromFrameAnatomy) {
  const formats::TestFolder folder;
  DicomTestFile file = multi_frame_file(4, 3, {0.0, 1.0});
  DicomTestFile anatomy, frame, position;
  anatomy.text(0x00209072, "CS", "L");
  std::vector<DicomTestFile> frames;
  for (const char* const place : {"-10\\20\\0", "-10\\20\\1"}) {
    position.text(0x00200032, "DS", place);
    frame.sequence(0x00209113, {position});
    frame.sequence(0x00209071, {anatomy});
    frames.push_back(frame);
  }
  file.sequence(0x52009230, frames);
  file.write(folder / "one.dcm");
  EXPECT_EQ(read_image(folder / "one.dcm").laterality, "L");
}

TEST(DicomFrames, TwoEchoesInOneFileAreToldApart) {
  DicomTestFile file = multi_frame_file(4, 3, {0.0, 0.0, 1.0, 1.0});
  file.sequence(0x52009230, {frame_of_echo(0, 2.3), frame_of_echo(0, 4.6), frame_of_echo(1, 2.3),
                             frame_of_echo(1, 4.6)});
  EXPECT_THAT(message_for(file),
              AllOf(HasSubstr("one.dcm (frame 1) and "),
                    HasSubstr("one.dcm (frame 2): two different images at one position (0.00 mm"),
                    HasSubstr("they differ in echo time (2.3 ms, 4.6 ms): an image of one of them "
                              "alone is required")));
}

TEST(DicomFrames, OffsetsPlaceFramesAlongTheNormal) {
  const formats::TestFolder folder;
  DicomTestFile file = old_style_file();
  file.text(0x00200032, "DS", "-10\\20\\30");
  file.text(0x3004000C, "DS", "0\\-2.5");
  file.write(folder / "one.dcm");
  const ImageFile relative = read_image(folder / "one.dcm");
  EXPECT_LT((relative.image.grid.to_patient(Vec3(0, 0, 0)) - Vec3(-10, 20, 27.5)).norm(), 1e-9);
  EXPECT_NEAR(relative.image.grid.spacing[2], 2.5, 1e-12);
  EXPECT_EQ(relative.image.value[0], 12.0F);  // the second frame is the lower one
  EXPECT_THAT(relative.notes, IsEmpty());
  file.text(0x3004000C, "DS", "30\\27.5");  // transversal slices: z of the patient
  file.write(folder / "one.dcm");
  const ImageFile absolute = read_image(folder / "one.dcm");
  EXPECT_EQ(absolute.image.value, relative.image.value);
  EXPECT_LT((absolute.image.grid.origin - relative.image.grid.origin).norm(), 1e-12);
}

TEST(DicomFrames, SpacingBetweenSlicesPlacesFramesWithANote) {
  const formats::TestFolder folder;
  DicomTestFile file = old_style_file();
  file.text(0x00180088, "DS", "1.2");
  file.write(folder / "one.dcm");
  const ImageFile read = read_image(folder / "one.dcm");
  EXPECT_NEAR(read.image.grid.spacing[2], 1.2, 1e-12);
  EXPECT_LT((read.image.grid.to_patient(Vec3(2, 1, 1)) - Vec3(-9.5, 20.5, 1.2)).norm(), 1e-9);
  EXPECT_EQ(read.image.value[read.image.grid.at(2, 1, 1)], 18.0F);
  EXPECT_THAT(read.notes, ElementsAre(AllOf(HasSubstr("one.dcm says where its first frame lies"),
                                            HasSubstr("1.2 mm apart"), HasSubstr("mirrored"))));
}

TEST(DicomFrames, FramesThatDoNotSayWhereTheyLieAreRefusedByName) {
  DicomTestFile file = old_style_file();
  EXPECT_THAT(message_for(file),
              HasSubstr("one.dcm (frame 1): holds 2 frames and doesn't say where each lies: it has "
                        "no Per-frame Functional Groups (5200,9230), Grid Frame Offset Vector "
                        "(3004,000C) or Spacing Between Slices (0018,0088)"));
  file.text(0x00180088, "DS", "-1");
  EXPECT_THAT(message_for(file), HasSubstr("Spacing Between Slices (0018,0088) is \"-1\" mm; 0.01 "
                                           "to 100 mm are allowed"));
  file.text(0x3004000C, "DS", "0\\1\\2");
  EXPECT_THAT(message_for(file),
              HasSubstr("Grid Frame Offset Vector (3004,000C) has 3 numbers for 2 frames"));
  file.text(0x3004000C, "DS", "5\\6");
  EXPECT_THAT(message_for(file),
              HasSubstr("Grid Frame Offset Vector (3004,000C) begins with 5 mm; 0 is required"));
  file.text(0x3004000C, "DS", "0\\1e9");
  EXPECT_THAT(message_for(file), HasSubstr("holds 1e+09 mm; up to 100000 mm are allowed"));
  file.element[0x00280009] = {"AT", std::string("\x18\x00\x63\x10", 4)};  // Frame Time
  EXPECT_THAT(message_for(file), HasSubstr("holds 2 frames that follow each other in time"));
  file.text(0x00280008, "IS", "two");
  EXPECT_THAT(message_for(file),
              HasSubstr("Number of Frames (0028,0008) is \"two\"; 1 to 20000 are allowed"));
}

TEST(DicomFrames, TheFrameWithAWrongPlaceIsNamed) {
  DicomTestFile file = multi_frame_file(4, 3, {0.0, 1.0, 2.0});
  std::vector<DicomTestFile> frames;
  for (const char* const place : {"-10\\20\\0", "-10\\20", "-10\\20\\2"}) {
    DicomTestFile position, frame;
    position.text(0x00200032, "DS", place);
    frame.sequence(0x00209113, {position});
    frames.push_back(frame);
  }
  file.sequence(0x52009230, frames);
  EXPECT_THAT(message_for(file),
              HasSubstr("one.dcm (frame 2): has no Image Position (0020,0032) of three numbers; it "
                        "says \"-10\\20\""));
}

TEST(DicomFrames, AFileThatIsNoImageIsNamed) {
  const formats::TestFolder folder;
  std::ofstream(folder / "a.txt") << "text";
  EXPECT_THAT(formats::message_of<InputError>([&] { find_dicom_series(folder / "a.txt"); }),
              HasSubstr("a.txt: is no DICOM file"));
}

}  // namespace
}  // namespace palmar::images
