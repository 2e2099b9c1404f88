// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace palmar::report {

/// A colour as screens take it: sRGB, 0 to 255.
struct Rgb {
  std::uint8_t r = 0, g = 0, b = 0;
  friend bool operator==(const Rgb&, const Rgb&) = default;
};

inline constexpr Rgb kWhite{255, 255, 255};
inline constexpr Rgb kBlack{0, 0, 0};

/// "#rrggbb", as HTML and SVG write a colour.
std::string hex_colour(Rgb colour);

/// Picture, row by row from the top left; a plain value.
struct Image {
  int width = 0;   ///< pixels
  int height = 0;  ///< pixels
  std::vector<Rgb> pixels;

  Image() = default;
  /// Throws UsageError unless both sides are 1 to 16384 pixels.
  Image(int image_width, int image_height, Rgb fill = kWhite);

  Rgb& at(int x, int y) { return pixels[index(x, y)]; }
  const Rgb& at(int x, int y) const { return pixels[index(x, y)]; }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

/// How hard the encoder tries: kFast is three times as fast for a quarter more bytes.
enum class PngEffort { kFast, kSmall };

/// Bytes of a PNG file (8 bit RGB, no time stamp: same picture, same bytes). Throws UsageError on
/// an empty image.
std::string encode_png(const Image& image, PngEffort effort = PngEffort::kFast);

/// The picture at `width` pixels, height in proportion; each pixel is the mean of the area it
/// covers. A picture that is not wider comes back as it is.
Image narrowed(const Image& image, int width);

/// The picture in a PNG file's bytes; grey, palette and 16 bit become RGB, transparency is placed
/// on white. Throws InputError if they are no PNG.
Image decode_png(std::string_view bytes);

}  // namespace palmar::report
