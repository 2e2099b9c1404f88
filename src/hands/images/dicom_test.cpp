// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/images/dicom.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "hands/images/dicom_test_files.h"
#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/process/external_program.h"
#include "palmar/formats/test_files.h"

namespace palmar::images {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

imaging::Volume oblique_image() {
  imaging::Volume image;
  image.grid.size = {7, 5, 6};
  image.grid.spacing = Vec3(0.78, 0.9, 1.3);
  image.grid.axes = Eigen::AngleAxisd(0.4, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  image.grid.origin = Vec3(-100.5, 20.25, -3.125);
  for (std::size_t v = 0; v < image.grid.count(); ++v) {
    image.value.push_back(static_cast<float>(300.0 * std::sin(0.7 * static_cast<double>(v))));
  }
  return image;
}

void expect_same_grid(const imaging::VolumeGrid& a, const imaging::VolumeGrid& b) {
  EXPECT_EQ(a.size, b.size);
  EXPECT_LT((a.spacing - b.spacing).norm(), 1e-9);
  EXPECT_LT((a.axes - b.axes).norm(), 1e-9);
  EXPECT_LT((a.origin - b.origin).norm(), 1e-9);  // 14 digits as text
}

TEST(DicomSeries, ObliqueImageWithNegativeValuesReadsBack) {
  const formats::TestFolder folder;
  const imaging::Volume image = oblique_image();
  DicomHeader header;
  header.description = "thumb flexion";
  header.laterality = "L";
  header.number = 3;
  write_dicom_series(folder / "s", image, header);
  const ImageFile file = read_image(folder / "s");
  expect_same_grid(file.image.grid, image.grid);
  EXPECT_EQ(file.description, "thumb flexion");
  EXPECT_EQ(file.laterality, "L");
  EXPECT_THAT(file.notes, IsEmpty());
  ASSERT_EQ(file.image.value.size(), image.value.size());
  for (std::size_t v = 0; v < image.value.size(); ++v) {
    // 16 bits with a step of 2^-6, half of which is lost: 300 stored within 32767.
    EXPECT_NEAR(file.image.value[v], image.value[v], 0.5 / 64) << v;
  }
}

TEST(DicomSeries, WholeNumbersAreKeptExactly) {
  const formats::TestFolder folder;
  imaging::Volume image = oblique_image();
  for (std::size_t v = 0; v < image.value.size(); ++v) {
    image.value[v] = static_cast<float>(v % 2 == 0 ? v : 30000 - v);
  }
  write_dicom_series(folder / "s", image, {});
  EXPECT_EQ(read_image(folder / "s").image.value, image.value);
}

TEST(DicomSeries, SlicesStackedAgainstTheirNormalLieWhereTheyWere) {
  const formats::TestFolder folder;
  imaging::Volume image = oblique_image();
  image.grid.axes.col(2) *= -1.0;  // left-handed
  write_dicom_series(folder / "s", image, {});
  const imaging::Volume read = read_image(folder / "s").image;
  const Vec3 voxel(2, 3, 1);
  const Vec3 at = read.grid.to_voxel(image.grid.to_patient(voxel));
  EXPECT_LT((at - Vec3(2, 3, 4)).norm(), 1e-9);  // the six slices the other way round
  EXPECT_NEAR(imaging::value_at(read, at), imaging::value_at(image, voxel), 0.5 / 64);
}

TEST(DicomSeries, SameImageGivesSameBytes) {
  const formats::TestFolder folder;
  write_dicom_series(folder / "a", oblique_image(), {});
  write_dicom_series(folder / "b", oblique_image(), {});
  EXPECT_EQ(formats::read_file(folder / "a/slice-0003.dcm"),
            formats::read_file(folder / "b/slice-0003.dcm"));
  EXPECT_NE(formats::read_file(folder / "a/slice-0003.dcm"),
            formats::read_file(folder / "a/slice-0004.dcm"));
}

TEST(DicomSeries, VoxelsLieWhereTheTagsSay) {
  // Spacing: 0.5 mm between rows, 0.25 mm between columns, 2 mm between slices.
  const formats::TestFolder folder;
  write_test_series(folder / "s");
  const ImageFile file = read_image(folder / "s");
  const imaging::VolumeGrid& grid = file.image.grid;
  EXPECT_EQ(grid.size, (std::array<int, 3>{4, 3, 4}));
  EXPECT_LT((grid.spacing - Vec3(0.25, 0.5, 2.0)).norm(), 1e-12);
  EXPECT_LT((grid.to_patient(Vec3(2, 1, 3)) - Vec3(-9.5, 20.5, 6.0)).norm(), 1e-9);
  EXPECT_EQ(file.image.value[grid.at(2, 1, 3)], 306.0F);  // row 1, column 2 of 4: the 6th after 300
}

TEST(DicomSeries, OrderComesFromPositionsWhateverTheNamesAndFolders) {
  const formats::TestFolder folder;
  const char* const names[] = {"z", "sub/a.dcm", "b.IMA", "deep/er/c"};
  for (int k = 0; k < 4; ++k) {
    DicomTestFile::slice(4, 3, 2.0 * k, 100 * k).write(folder / names[k]);
  }
  std::ofstream(folder / "notes.txt") << "no image";
  const imaging::Volume image = read_image(folder.path()).image;
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(image.value[image.grid.at(0, 0, k)], 100.0F * static_cast<float>(k));
  }
}

TEST(DicomSeries, ImplicitSyntaxAndMissingPreambleRead) {
  const formats::TestFolder folder;
  for (int k = 0; k < 3; ++k) {
    DicomTestFile file = DicomTestFile::slice(4, 3, k, 10 * k);
    file.is_explicit = false;
    file.has_preamble = k != 1;
    file.write(folder / ("s/" + std::to_string(k) + ".dcm"));
  }
  EXPECT_EQ(read_image(folder / "s").image.value[2 * 12 + 11], 31.0F);
}

TEST(DicomSeries, SequencesOfUnknownLengthArePassedOver) {
  const formats::TestFolder folder;
  // Two items, one of them of unknown length with a sequence in it.
  const std::string item("\xFE\xFF\x00\xE0", 4), item_end("\xFE\xFF\x0D\xE0\0\0\0\0", 8),
      end("\xFE\xFF\xDD\xE0\0\0\0\0", 8), unknown("\xFF\xFF\xFF\xFF", 4);
  const std::string inner =
      std::string("\x08\0\x10\x11SQ\0\0", 8) + unknown + item + DicomTestFile::four_bytes(0) + end;
  const std::string sequence = std::string("\x08\0\x40\x11SQ\0\0", 8) + unknown + item +
                               DicomTestFile::four_bytes(4) + "abcd" + item + unknown + inner +
                               item_end + end;
  for (int k = 0; k < 2; ++k) {
    const DicomTestFile file = DicomTestFile::slice(4, 3, k, 10 * k);
    std::string bytes = file.bytes();
    bytes.insert(bytes.find(std::string("\x20\0\x0E\0UI", 6)), sequence);
    fs::create_directories(folder / "s");
    std::ofstream(folder / ("s/" + std::to_string(k))) << bytes;
  }
  EXPECT_EQ(read_image(folder / "s").image.value[12], 10.0F);
}

TEST(DicomSeries, StoredBitsBecomeIntensities) {
  const formats::TestFolder folder;
  for (int k = 0; k < 2; ++k) {
    DicomTestFile file = DicomTestFile::slice(2, 2, k);
    file.number(0x00280101, 12);  // 12 bits, signed; the upper 4 hold something else
    file.number(0x00280102, 11);
    file.number(0x00280103, 1);
    file.text(0x00281053, "DS", "0.5");
    file.text(0x00281052, "DS", "-3");
    file.pixels({0xF001, 0xAFFF, 0x5800, 0x07FF});  // 1, -1, -2048, 2047
    file.write(folder / ("s/" + std::to_string(k)));
  }
  EXPECT_THAT(read_image(folder / "s").image.value,
              ElementsAre(-2.5F, -3.5F, -1027.0F, 1020.5F, -2.5F, -3.5F, -1027.0F, 1020.5F));
}

TEST(DicomSeries, GapsBetweenSlicesCount) {
  const formats::TestFolder folder;
  for (int k = 0; k < 3; ++k) {
    DicomTestFile file = DicomTestFile::slice(4, 3, 1.5 * k);
    file.text(0x00180050, "DS", "1");
    file.write(folder / ("s/" + std::to_string(k)));
  }
  const ImageFile file = read_image(folder / "s");
  EXPECT_NEAR(file.image.grid.spacing[2], 1.5, 1e-12);
  EXPECT_THAT(file.notes, ElementsAre("slices 1 mm thick are 1.5 mm apart (from their positions)"));
}

TEST(DicomSeries, IdenticalDoublesAreLeftOut) {
  const formats::TestFolder folder;
  write_test_series(folder / "s");
  fs::copy(folder / "s/2.dcm", folder / "s/copy.dcm");
  const ImageFile file = read_image(folder / "s");
  EXPECT_EQ(file.image.grid.size[2], 4);
  EXPECT_THAT(file.notes, ElementsAre("1 slice was left out that another repeats: copy.dcm"));
}

TEST(DicomSeries, OneOfSeveralIsChosen) {
  const formats::TestFolder folder;
  write_test_series(folder / "a");
  for (int k = 0; k < 4; ++k) {
    DicomTestFile file = DicomTestFile::slice(4, 3, k, 1000);
    file.text(0x0020000E, "UI", "1.2.3.5");
    file.text(0x00200011, "IS", "9");
    file.text(0x0008103E, "LO", "Grasp");
    file.write(folder / ("b/" + std::to_string(k)));
  }
  // A localiser: three slices, each in its own direction.
  const char* const directions[] = {"1\\0\\0\\0\\1\\0", "1\\0\\0\\0\\0\\-1", "0\\1\\0\\0\\0\\-1"};
  for (int k = 0; k < 3; ++k) {
    DicomTestFile file = DicomTestFile::slice(4, 3, k);
    file.text(0x0020000E, "UI", "1.2.3.6");
    file.text(0x00200011, "IS", "1");
    file.text(0x0008103E, "LO", "scout");
    file.text(0x00200037, "DS", directions[k]);
    file.write(folder / ("c/" + std::to_string(k)));
  }
  const auto series = find_dicom_series(folder.path());
  ASSERT_EQ(series.size(), 3U);
  EXPECT_EQ(series[0].description, "scout");
  EXPECT_THAT(series[0].refusal, HasSubstr("3 directions"));
  EXPECT_EQ(series[1].slices, 4);
  EXPECT_EQ(series[1].refusal, "");
  EXPECT_EQ(series[2].number, 9);

  const std::string message = formats::message_of<InputError>([&] { read_image(folder.path()); });
  EXPECT_THAT(message, HasSubstr("several series; choose one"));
  EXPECT_THAT(message, HasSubstr("7 \"t1 coronal\", 4 slices of 4 x 3"));
  EXPECT_THAT(message, HasSubstr("9 \"Grasp\", 4 slices of 4 x 3"));
  EXPECT_EQ(read_image(folder.path(), {9, ""}).image.value[0], 1000.0F);
  EXPECT_EQ(read_image(folder.path(), {std::nullopt, "gras"}).image.value[0], 1000.0F);
  EXPECT_EQ(read_image(folder.path(), {7, "t1"}).image.value[0], 0.0F);
  EXPECT_THAT(formats::message_of<InputError>([&] {
                read_image(folder.path(), {5, ""});
              }),
              HasSubstr("no series with number 5; there are:\n  1 \"scout\""));
  EXPECT_THAT(formats::message_of<InputError>([&] {
                read_image(folder.path(), {1, ""});
              }),
              HasSubstr("series 1 \"scout\": slices are in 3 directions"));
  fs::remove_all(folder / "b");  // then the localiser doesn't stand in the way
  EXPECT_EQ(read_image(folder.path()).description, "t1 coronal");
}

TEST(DicomSeries, FramesOfOneFileBecomeSlices) {
  for (const bool is_open : {false, true}) {  // sequences with lengths, with delimiters
    const formats::TestFolder folder;
    multi_frame_file(4, 3, {4.0, 0.0, 2.0}, is_open).write(folder / "s/all.dcm");
    const auto series = find_dicom_series(folder / "s");
    ASSERT_EQ(series.size(), 1U);
    EXPECT_EQ(series[0].slices, 3);
    EXPECT_EQ(series[0].files.size(), 1U);
    const ImageFile file = read_image(folder / "s");
    EXPECT_EQ(file.image.grid.size, (std::array<int, 3>{4, 3, 3}));
    EXPECT_LT((file.image.grid.spacing - Vec3(0.25, 0.5, 2.0)).norm(), 1e-12);
    // By position the second frame is first; values are 2 stored + 1.
    EXPECT_EQ(file.image.value[0], 201.0F);
    EXPECT_EQ(file.image.value[12], 401.0F);
    EXPECT_EQ(file.image.value[24 + 11], 23.0F);
  }
}

TEST(DicomSeries, AFileOfAnotherProgramReads) {
  const auto program = formats::find_program("dump2dcm");
  if (!program) GTEST_SKIP() << "dump2dcm (Debian package dcmtk) isn't installed";
  const formats::TestFolder folder;
  fs::create_directories(folder / "s");
  for (int k = 0; k < 2; ++k) {
    std::ofstream(folder / "dump.txt")
        << "(0008,0016) UI =MRImageStorage\n(0008,0018) UI [1.2.3." << k
        << "]\n(0008,1140) SQ\n(fffe,e000) -\n(0008,1155) UI [1.2.9]\n(fffe,e00d) -\n"
           "(fffe,e0dd) -\n(0020,000d) UI [1.2]\n(0020,000e) UI [1.2.4]\n(0020,0032) DS [1\\2\\"
        << 3 - k << "]\n"
        << "(0020,0037) DS [0\\1\\0\\1\\0\\0]\n(0020,0060) CS [R]\n(0028,0002) US 1\n"
           "(0028,0004) CS [MONOCHROME2]\n(0028,0010) US 1\n(0028,0011) US 2\n"
           "(0028,0030) DS [1\\2]\n(0028,0100) US 16\n(0028,0101) US 16\n(0028,0102) US 15\n"
           "(0028,0103) US 0\n(7fe0,0010) OW "
        << (k == 0 ? "0005\\0006" : "0007\\0008") << "\n";
    // Sequences with unknown length once, with known length once.
    ASSERT_EQ(
        formats::run_program(*program, {k == 0 ? "-e" : "+e", "dump.txt", "s/" + std::to_string(k)},
                             folder.path(), "log"),
        0)
        << formats::read_file(folder / "log");
  }
  // Rows along +y, columns along +x: the normal is -z, so that the higher slice comes first.
  const ImageFile file = read_image(folder / "s");
  EXPECT_EQ(file.laterality, "R");
  EXPECT_THAT(file.image.value, ElementsAre(5.0F, 6.0F, 7.0F, 8.0F));
  EXPECT_LT((file.image.grid.to_patient(Vec3(1, 0, 1)) - Vec3(1, 4, 2)).norm(), 1e-9);
}

TEST(DicomSeries, AnotherProgramFindsNoErrorInWhatIsWritten) {
  const auto program = formats::find_program("dciodvfy");
  if (!program) GTEST_SKIP() << "dciodvfy (Debian package dicom3tools) isn't installed";
  const formats::TestFolder folder;
  DicomHeader header;
  header.laterality = "R";
  header.description = "reference";
  write_dicom_series(folder / "s", oblique_image(), header);
  EXPECT_EQ(formats::run_program(*program, {"s/slice-0001.dcm"}, folder.path(), "log"), 0);
  const std::string log = formats::read_file(folder / "log");
  EXPECT_THAT(log, HasSubstr("MRImage"));
  EXPECT_THAT(log, ::testing::Not(HasSubstr("Error")));
}

}  // namespace
}  // namespace palmar::images
