// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/images/exif.h"

#include <gtest/gtest.h>

#include <string>

namespace palmar::images {
namespace {

std::string bytes(std::initializer_list<int> values) {
  std::string text;
  for (const int value : values) text += static_cast<char>(value);
  return text;
}

/// A JPEG file's beginning, written out by the specification: a comment, then the data in
/// little-endian order: model "AB", focal length 17/4 mm, 29 mm on film.
std::string known() {
  const std::string tiff =
      std::string("II*\0", 4) + bytes({8, 0, 0, 0}) +
      bytes({2,    0,                                       // two fields
             0x10, 0x01, 2, 0, 3, 0, 0, 0, 'A', 'B', 0, 0,  // model
             0x69, 0x87, 4, 0, 1, 0, 0, 0, 38,  0,   0, 0,  // more fields at 38
             0,    0,    0, 0}) +
      bytes({2,    0,                                    //
             0x0A, 0x92, 5, 0, 1, 0, 0, 0, 68, 0, 0, 0,  // focal length at 68
             0x05, 0xA4, 3, 0, 1, 0, 0, 0, 29, 0, 0, 0,  // on film
             0,    0,    0, 0}) +
      bytes({17, 0, 0, 0, 4, 0, 0, 0});
  const std::string exif = std::string("Exif\0\0", 6) + tiff;
  return bytes({0xFF, 0xD8, 0xFF, 0xFE, 0, 4, 'h', 'i', 0xFF, 0xE1, 0,
                static_cast<int>(exif.size()) + 2}) +
         exif + bytes({0xFF, 0xDA, 0, 2});
}

TEST(Exif, ReadsWhatTheSpecificationSays) {
  const auto exif = read_exif(known());
  ASSERT_TRUE(exif);
  EXPECT_EQ(exif->camera, "AB");
  EXPECT_DOUBLE_EQ(exif->focal_mm, 4.25);
  EXPECT_DOUBLE_EQ(exif->focal_35mm, 29.0);
  // 29 mm on a diagonal of 43.267 mm, 5 pixels' on one of 5000.
  EXPECT_NEAR(*exif->focal_pixels(3000, 4000), 29.0 * 5000.0 / 43.2666, 0.01);
}

TEST(Exif, FocalLengthBySensor) {
  PhotoExif exif;
  EXPECT_FALSE(exif.focal_pixels(100, 100));
  exif.focal_mm = 35.0;
  exif.pixels_per_mm = 200.0;
  exif.width = 6000;
  exif.height = 4000;
  EXPECT_DOUBLE_EQ(*exif.focal_pixels(6000, 4000), 7000.0);
  EXPECT_DOUBLE_EQ(*exif.focal_pixels(1000, 1500), 1750.0);  // turned and made smaller
}

TEST(Exif, ACroppedPictureHasOtherProportions) {
  PhotoExif exif;
  EXPECT_FALSE(exif.is_cropped(100, 300)) << "nothing is known";
  exif.width = 4032;
  exif.height = 3024;
  EXPECT_FALSE(exif.is_cropped(4032, 3024));
  EXPECT_FALSE(exif.is_cropped(1008, 1344)) << "turned and made smaller";
  EXPECT_FALSE(exif.is_cropped(1000, 751)) << "rounded";
  EXPECT_TRUE(exif.is_cropped(4032, 2800));
  EXPECT_TRUE(exif.is_cropped(3024, 3024));
}

TEST(Exif, WhatIsWrittenIsRead) {
  const PhotoExif exif{"Maker C-1 77", 4.2, 26.0, 714.286, 4032, 3024};
  const std::string segment = format_exif(exif);
  const auto size = static_cast<int>(segment.size()) + 2;
  const auto read = read_exif(bytes({0xFF, 0xD8, 0xFF, 0xE1, size / 256, size % 256}) + segment);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->camera, exif.camera);
  EXPECT_NEAR(read->focal_mm, exif.focal_mm, 1e-9);
  EXPECT_NEAR(read->pixels_per_mm, exif.pixels_per_mm, 1e-3);
  EXPECT_EQ(read->width, 4032);
  EXPECT_EQ(read->focal_35mm, 26.0);
}

TEST(Exif, DamagedDataAreNone) {
  EXPECT_FALSE(read_exif("no picture"));
  EXPECT_FALSE(read_exif(bytes({0xFF, 0xD8, 0xFF, 0xDA, 0, 2})));
  const std::string whole = known();
  for (std::size_t n = 0; n < whole.size(); ++n) {
    read_exif(whole.substr(0, n));  // neither crashes nor reads beyond the end
    std::string wrong = whole;
    wrong[n] = static_cast<char>(0xFF);
    read_exif(wrong);
  }
}

}  // namespace
}  // namespace palmar::images
