// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/picture/image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"

namespace palmar::report {
namespace {

TEST(Png, ComesBackPixelForPixel) {
  Image image(7, 5);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      image.at(x, y) = {static_cast<std::uint8_t>(36 * x), static_cast<std::uint8_t>(60 * y),
                        static_cast<std::uint8_t>(x * y)};
    }
  }
  const std::string bytes = encode_png(image);
  // Signature of RFC 2083, section 3.1.
  EXPECT_EQ(bytes.substr(0, 8), std::string("\x89PNG\r\n\x1a\n", 8));
  const Image back = decode_png(bytes);
  EXPECT_EQ(back.width, 7);
  EXPECT_EQ(back.height, 5);
  EXPECT_EQ(back.pixels, image.pixels);
  EXPECT_EQ(encode_png(image), bytes);
}

TEST(Png, DamagedBytesAreAnInputError) {
  const std::string bytes = encode_png(Image(20, 20));
  EXPECT_THROW(decode_png("no picture"), InputError);
  EXPECT_THROW(decode_png(bytes.substr(0, bytes.size() / 2)), InputError);
  EXPECT_THROW(decode_png(""), InputError);
}

TEST(Image, SizeOutOfRangeIsNamed) {
  try {
    Image(0, 12);
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("0 x 12 pixels"));
  }
  EXPECT_THROW(encode_png(Image()), UsageError);
}

TEST(HexColour, IsWrittenAsInHtml) { EXPECT_EQ(hex_colour({255, 0, 10}), "#ff000a"); }

TEST(Narrowed, PixelsAreMeansOfWhatTheyCover) {
  Image image(3, 3, Rgb{0, 0, 0});
  for (int y = 0; y < 3; ++y) image.at(0, y) = {240, 90, 0};
  // 3 pixels on 2: the left one covers all of column 0 and half of column 1.
  const Image small = narrowed(image, 2);
  ASSERT_EQ(small.width, 2);
  ASSERT_EQ(small.height, 2);
  EXPECT_EQ(small.at(0, 0), (Rgb{160, 60, 0}));
  EXPECT_EQ(small.at(1, 1), (Rgb{0, 0, 0}));
  EXPECT_EQ(narrowed(image, 8).width, 3);
  EXPECT_EQ(narrowed(Image(1000, 700, Rgb{7, 8, 9}), 720).at(719, 503), (Rgb{7, 8, 9}));
}

}  // namespace
}  // namespace palmar::report
