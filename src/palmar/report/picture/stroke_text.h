// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/report/picture/image.h"

namespace palmar::report {

enum class Align { kLeft, kCentre, kRight };

struct TextStyle {
  double cap_height = 14.0;  ///< height of a capital, pixels
  Rgb colour{34, 40, 46};
  Align align = Align::kLeft;
  double weight = 0.13;  ///< stroke width as a share of the capital's height
};

/// Writes a line of text into a picture with Palmar's own stroke font (smooth at any size, no font
/// file): ASCII letters, digits, punctuation, and ² ³ ° · × ± – − ≥ ≤ from UTF-8; accents are left
/// out, what it lacks is drawn as a box. (x, y) is the left, middle or right end of the base line,
/// pixels.
void draw_text(Image& image, double x, double y, std::string_view text,
               const TextStyle& style = {});

/// Width of a line of text, pixels.
double text_width(std::string_view text, const TextStyle& style = {});

/// The lines that draw_text() would draw with a pen, pixels: left end of the base line at (0, 0), y
/// down, so that they can be turned and stretched.
std::vector<std::vector<Eigen::Vector2d>> text_strokes(std::string_view text, double cap_height);

/// Code points of UTF-8 text; broken bytes give some code point each.
std::vector<char32_t> code_points(std::string_view text);

/// Fills the rectangle [x, x + width) x [y, y + height), clipped to the picture.
void fill_rectangle(Image& image, int x, int y, int width, int height, Rgb colour);

}  // namespace palmar::report
