// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/images/dicom_readout.h"

#include <gtest/gtest.h>

#include "hands/images/dicom.h"
#include "hands/images/dicom_test_files.h"
#include "palmar/formats/test_files.h"

namespace palmar::images {
namespace {

// A scanner of 1.5 tesla, 110 Hz a pixel; pixels of 0.25 mm along the rows, 0.5 mm down.
Vec3 shift_of(const std::vector<std::pair<std::uint32_t, std::string>>& others) {
  const formats::TestFolder folder;
  for (int k = 0; k < 3; ++k) {
    DicomTestFile file = DicomTestFile::slice(4, 3, k, 10 * k);
    file.text(0x00180084, "DS", "63.87");
    file.text(0x00180095, "DS", "110");
    file.text(0x00181312, "CS", "COL");
    for (const auto& [tag, text] : others) {
      if (tag == 0x00181310) {
        file.element[tag] = {"US", text};
      } else {
        file.text(tag, "CS", text);
      }
    }
    file.write(folder / ("s/" + std::to_string(k) + ".dcm"));
  }
  return read_image(folder / "s").fat_shift;
}

// Fat 3.35 ppm below water: 214 Hz at 63.87 MHz, 1.945 acquired pixels.
TEST(DicomReadout, FatIsOffByItsFrequencyOverTheBandwidth) {
  EXPECT_LT((shift_of({}) - Vec3(1.945 * 0.25, 0, 0)).norm(), 1e-3);
}

TEST(DicomReadout, RunsAcrossThePhaseEncoding) {
  EXPECT_LT((shift_of({{0x00181312, "ROW"}}) - Vec3(0, 1.945 * 0.5, 0)).norm(), 1e-3);
}

TEST(DicomReadout, APixelThatWasInterpolatedIsSmallerThanTheAcquiredOne) {
  const std::string two_samples = DicomTestFile::two_bytes(0) + DicomTestFile::two_bytes(2) +
                                  DicomTestFile::two_bytes(2) + DicomTestFile::two_bytes(0);
  EXPECT_LT((shift_of({{0x00181310, two_samples}}) - Vec3(1.945 * 0.5, 0, 0)).norm(), 1e-3);
}

TEST(DicomReadout, WhatTheFileDoesntSayIsNoShift) {
  EXPECT_EQ(shift_of({{0x00180095, ""}}), Vec3::Zero());
  EXPECT_EQ(shift_of({{0x00180095, "0"}}), Vec3::Zero());
  EXPECT_EQ(shift_of({{0x00180095, "much"}}), Vec3::Zero());
  EXPECT_EQ(shift_of({{0x00180084, "-5"}}), Vec3::Zero());
  EXPECT_EQ(shift_of({{0x00181312, "OTHER"}}), Vec3::Zero());
}

TEST(DicomReadout, WhatIsWrittenIsReadAgain) {
  const formats::TestFolder folder;
  imaging::Volume image;
  image.grid.size = {4, 3, 3};
  image.grid.spacing = Vec3(0.8, 0.8, 1.0);
  image.value.assign(image.grid.count(), 5.0F);
  DicomHeader header;
  header.fat_shift = 0.8;
  write_dicom_series(folder / "s", image, header);
  EXPECT_LT((read_image(folder / "s").fat_shift - Vec3(0.8, 0, 0)).norm(), 1e-6);
}

}  // namespace
}  // namespace palmar::images
