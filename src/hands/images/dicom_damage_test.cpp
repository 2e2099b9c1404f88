// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "hands/images/dicom.h"
#include "hands/images/dicom_test_files.h"
#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/test_files.h"

namespace palmar::images {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// What reading says of a folder; "" if it reads.
std::string message_for(const fs::path& path) {
  return formats::message_of<InputError>([&] { read_image(path); });
}

/// What reading says of four slices, the third of which `change` has altered.
template <typename Change>
std::string with_changed_slice(const Change& change) {
  const formats::TestFolder folder;
  write_test_series(folder / "s");
  DicomTestFile file = DicomTestFile::slice(4, 3, 4.0, 200);
  change(file);
  file.write(folder / "s/2.dcm");
  return message_for(folder / "s");
}

TEST(DicomDamage, FoldersWithoutASeriesAreNamed) {
  const formats::TestFolder folder;
  fs::create_directories(folder / "empty/inner");
  EXPECT_THAT(message_for(folder / "empty"),
              HasSubstr("empty: is empty; DICOM files are required"));
  std::ofstream(folder / "empty/a.txt") << "text";
  EXPECT_THAT(message_for(folder / "empty"), HasSubstr("none of its 1 file is DICOM"));
  EXPECT_THAT(message_for(folder / "none"), HasSubstr("none: no such file or folder"));
  EXPECT_THAT(
      formats::message_of<InputError>([&] { find_dicom_series(folder / "empty/a.txt"); }),
      HasSubstr("is no DICOM file; a folder of them, or one of several frames, is required"));
  write_test_series(folder / "s");
  EXPECT_THAT(message_for(folder / "s/1.dcm"),
              HasSubstr("is one DICOM file of one slice; the folder with its series is required"));
}

TEST(DicomDamage, MissingSlicesAreNamedByPosition) {
  const formats::TestFolder folder;
  for (int k = 0; k < 9; ++k) {
    if (k == 3 || k == 6 || k == 7) continue;
    DicomTestFile::slice(4, 3, 2.0 * k).write(folder / ("s/" + std::to_string(k) + ".dcm"));
  }
  EXPECT_THAT(message_for(folder / "s"),
              HasSubstr("3 slices are missing, at 6.00, 12.00, 14.00 mm along the slices' normal "
                        "(the first behind 2.dcm at 4.00 mm, before 4.dcm at 8.00 mm; slices are "
                        "2 mm apart)"));
}

TEST(DicomDamage, UnevenSlicesAreNamed) {
  EXPECT_THAT(
      with_changed_slice([](DicomTestFile& file) { file.text(0x00200032, "DS", "-10\\20\\4.5"); }),
      HasSubstr("slices are unevenly spaced: 1.5 mm between 2.dcm and 3.dcm, 2.5 mm "
                "between 1.dcm and 2.dcm"));
}

TEST(DicomDamage, TwoImagesAtOnePlaceContradict) {
  const formats::TestFolder folder;
  write_test_series(folder / "s");
  DicomTestFile::slice(4, 3, 4.0, 999).write(folder / "s/x.dcm");
  const std::string message = message_for(folder / "s");
  EXPECT_THAT(message, HasSubstr("s/2.dcm and "));
  EXPECT_THAT(message, HasSubstr("s/x.dcm: two different images at one position (4.00 mm"));
}

TEST(DicomDamage, MixturesAreNamed) {
  EXPECT_THAT(
      with_changed_slice([](DicomTestFile& file) { file = DicomTestFile::slice(3, 4, 4.0); }),
      HasSubstr("images of several sizes are mixed: 0.dcm has 4 x 3 pixels, 2.dcm has 3 x "
                "4"));
  EXPECT_THAT(
      with_changed_slice([](DicomTestFile& file) { file.text(0x00280030, "DS", "0.5\\0.3"); }),
      HasSubstr("images of several pixel sizes are mixed"));
  EXPECT_THAT(with_changed_slice(
                  [](DicomTestFile& file) { file.text(0x00200037, "DS", "1\\0\\0\\0\\0\\1"); }),
              HasSubstr("slices are in 2 directions, as those of a localiser (0.dcm and 2.dcm)"));
  EXPECT_THAT(
      with_changed_slice([](DicomTestFile& file) { file.text(0x00200032, "DS", "-10\\20.4\\4"); }),
      HasSubstr("slices are shifted sideways, 2.dcm by 0.40 mm against 0.dcm"));
}

TEST(DicomDamage, WhatIsNoGreyVolumeIsNamed) {
  EXPECT_THAT(with_changed_slice([](DicomTestFile& file) {
                file.number(0x00280002, 3);
                file.text(0x00280004, "CS", "RGB");
              }),
              HasSubstr("2.dcm: is a colour image (RGB); grey values are required"));
  EXPECT_THAT(
      with_changed_slice([](DicomTestFile& file) { file.text(0x00280008, "IS", "60"); }),
      HasSubstr(
          "2.dcm (frame 1): is cut off: 60 frames of 4 x 3 pixels of 16 bits need 1440 bytes, 24 "
          "are there"));
  EXPECT_THAT(
      with_changed_slice([](DicomTestFile& file) { file.transfer_syntax = "1.2.840.10008.1.2.2"; }),
      HasSubstr("2.dcm: is big-endian, which isn't read"));
  EXPECT_THAT(with_changed_slice([](DicomTestFile& file) { file.element.erase(0x7FE00010); }),
              HasSubstr("2.dcm: holds no pixels"));
}

TEST(DicomDamage, FramesWithoutAPlaceAreNamed) {
  const formats::TestFolder folder;
  const auto message = [&](const DicomTestFile& file) {
    file.write(folder / "s/all.dcm");
    return message_for(folder / "s");
  };
  DicomTestFile file = multi_frame_file(4, 3, {0.0, 1.0, 2.0});
  file.text(0x00280008, "IS", "2");
  EXPECT_THAT(message(file),
              HasSubstr("all.dcm (frame 1): holds 2 frames and says of 3 where they lie"));
  file = multi_frame_file(4, 3, {0.0, 1.0, 2.0});
  file.element.erase(0x52009229);
  EXPECT_THAT(message(file), HasSubstr("all.dcm (frame 1): has no Image Orientation"));
  EXPECT_THAT(message(multi_frame_file(4, 3, {0.0, 1.0, 2.4, 3.0})), HasSubstr("unevenly spaced"));
  const std::string whole = multi_frame_file(4, 3, {0.0, 1.0, 2.0}).bytes();
  std::mt19937 random(2);
  for (int n = 0; n < 300; ++n) {
    std::string bytes = whole;
    for (int m = 0; m < 3; ++m)
      bytes[128 + random() % (bytes.size() - 128)] = static_cast<char>(random());
    if (n % 5 == 0) bytes.resize(random() % bytes.size() + 1);
    std::ofstream(folder / "s/all.dcm", std::ios::binary) << bytes;
    message_for(folder / "s");  // reads, or throws InputError
  }
}

TEST(DicomDamage, TagsThatCannotBeAreNamed) {
  const auto with_text = [](std::uint32_t tag, const std::string& text) {
    return with_changed_slice([&](DicomTestFile& file) { file.text(tag, "DS", text); });
  };
  EXPECT_THAT(with_text(0x00200032, "1\\nan\\3"),
              HasSubstr("2.dcm: has no Image Position (0020,0032) of three numbers"));
  EXPECT_THAT(with_text(0x00200037, "1\\0\\0"),
              HasSubstr("has no Image Orientation (0020,0037) of six numbers"));
  EXPECT_THAT(with_text(0x00200037, "2\\0\\0\\0\\1\\0"), HasSubstr("an axis has length 2"));
  EXPECT_THAT(with_text(0x00200037, "1\\0\\0\\0.5\\0.8660254\\0"),
              HasSubstr("aren't square; the angle between them is 60.00 degrees"));
  EXPECT_THAT(with_text(0x00280030, "0\\1"), HasSubstr("Pixel Spacing (0028,0030) is 0 mm"));
  EXPECT_THAT(with_text(0x00281053, "x"),
              HasSubstr("Rescale Slope (0028,1053) is \"x\"; a number is required"));
  EXPECT_THAT(with_changed_slice([](DicomTestFile& file) { file.number(0x00280010, 65535); }),
              HasSubstr("2.dcm: is cut off: 4 x 65535 pixels of 16 bits need 524280 bytes, 24 are "
                        "there"));
  EXPECT_THAT(with_changed_slice([](DicomTestFile& file) { file.number(0x00280101, 20); }),
              HasSubstr("20 bits stored up to bit 15 don't fit 16 bits allocated"));
}

TEST(DicomDamage, CutOrOverwrittenFilesAreNamed) {
  const formats::TestFolder folder;
  const std::string whole = DicomTestFile::slice(4, 3, 4.0, 200).bytes();
  const auto message_with = [&](const std::string& bytes) {
    write_test_series(folder / "s");
    std::ofstream(folder / "s/2.dcm", std::ios::binary) << bytes;
    return message_for(folder / "s");
  };
  EXPECT_EQ(message_with(whole), "");
  EXPECT_THAT(message_with(whole.substr(0, whole.size() - 10)),
              HasSubstr("2.dcm: byte " + std::to_string(whole.size() - 24) +
                        ": the pixels end after 14 of 24 bytes"));
  EXPECT_THAT(message_with(whole.substr(0, 300)), HasSubstr("2.dcm: byte "));
  EXPECT_THAT(message_with(""), HasSubstr("2.dcm: is empty (0 bytes)"));
  EXPECT_THAT(message_with("XXXX" + whole.substr(0, 100)),
              HasSubstr("2.dcm: doesn't begin as a DICOM file does"));
  EXPECT_THAT(message_with(whole.substr(0, 132) + std::string(300, '\xFF')),
              HasSubstr("2.dcm: byte "));
}

TEST(DicomDamage, FuzzedFilesAreReadOrRefusedByName) {
  const formats::TestFolder folder;
  std::mt19937 random(7);
  const auto any = [&](std::size_t below) { return static_cast<std::size_t>(random()) % below; };
  const std::string whole = DicomTestFile::slice(4, 3, 4.0, 200).bytes();
  int refused = 0;
  write_test_series(folder / "s");
  for (int n = 0; n < 400; ++n) {
    std::string bytes = whole;
    for (std::size_t m = 0; m < 1 + any(4); ++m) {
      bytes[128 + any(bytes.size() - 128)] = static_cast<char>(any(256));
    }
    if (n % 7 == 0) bytes.insert(128 + any(bytes.size() - 128), std::string(any(40), '\xFF'));
    if (n % 5 == 0) bytes.resize(any(bytes.size()));
    std::ofstream(folder / "s/2.dcm", std::ios::binary) << bytes;
    try {
      const ImageFile file = read_image(folder / "s");
      EXPECT_LE(file.image.value.size(), 48U);
    } catch (const InputError& error) {
      ++refused;
      EXPECT_GT(std::string(error.what()).size(), 20U);
    }
  }
  EXPECT_GT(refused, 100);
}

TEST(DicomDamage, DroppedDoubledAndShuffledSlicesAreDistinguished) {
  const formats::TestFolder folder;
  std::mt19937 random(3);
  constexpr int kSlices = 12;
  for (int n = 0; n < 60; ++n) {
    const fs::path path = folder / ("n" + std::to_string(n));
    std::vector<int> copies(kSlices);
    for (int& count : copies) count = random() % 8 == 0 ? 0 : random() % 8 == 0 ? 2 : 1;
    copies.front() = std::max(1, copies.front());
    copies.back() = std::max(1, copies.back());
    const bool is_doubled = std::count(copies.begin(), copies.end(), 2) > 0;
    const auto missing = std::count(copies.begin(), copies.end(), 0);
    int left = 0;
    for (int k = 0; k < kSlices; ++k) {
      for (int c = 0; c < copies[static_cast<std::size_t>(k)]; ++c) {
        ++left;
        DicomTestFile::slice(4, 3, 0.7 * k, k).write(path / std::to_string(random()));
      }
    }
    std::string message;
    try {
      const ImageFile file = read_image(path);
      EXPECT_EQ(file.image.grid.size[2], kSlices);
      EXPECT_EQ(file.notes.size(), is_doubled ? 1U : 0U);
      for (int k = 0; k < kSlices; ++k) {
        EXPECT_EQ(file.image.value[file.image.grid.at(0, 0, k)], static_cast<float>(k));
      }
      EXPECT_EQ(missing, 0) << n;
    } catch (const InputError& error) {
      EXPECT_GT(missing, 0) << error.what();
      EXPECT_THAT(error.what(),
                  HasSubstr(missing == 1 ? "1 slice is missing"
                                         : std::to_string(missing) + " slices are missing"));
    }
  }
}

TEST(DicomDamage, AnImageThatIsNotFiniteIsNotWritten) {
  const formats::TestFolder folder;
  imaging::Volume image;
  image.grid.size = {2, 2, 2};
  image.value.assign(8, 1.0F);
  image.value[3] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(
      formats::message_of<OutputError>([&] { write_dicom_series(folder / "s", image, {}); }),
      HasSubstr("values that aren't finite"));
  image.value.pop_back();
  EXPECT_THAT(
      formats::message_of<OutputError>([&] { write_dicom_series(folder / "s", image, {}); }),
      HasSubstr("7 values for 8 voxels"));
}

}  // namespace
}  // namespace palmar::images
