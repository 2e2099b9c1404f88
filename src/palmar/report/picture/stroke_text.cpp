// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/picture/stroke_text.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace palmar::report {

namespace {

using Vec2 = Eigen::Vector2d;
using Stroke = std::vector<Vec2>;

// A glyph on a grid of x 0..6, y 0..9: base line 2, small letters to 6, capitals to 8, descenders
// to 0. Strokes are lists of "xy" pairs: '-' straight, '~' rounded between its ends, 'o' rounded
// and closed.
struct Glyph {
  char32_t code;
  std::string_view strokes;
};

constexpr std::array kGlyphs{
    Glyph{U'0', "o 08 48 42 02"},
    Glyph{U'1', "- 06 28 22"},
    Glyph{U'2', "~ 06 08 48 45 02 - 02 42"},
    Glyph{U'3', "~ 07 18 48 45 15 ~ 15 45 42 02 03"},
    Glyph{U'4', "- 32 38 04 44"},
    Glyph{U'5', "- 48 08 05 ~ 05 26 46 42 02 03"},
    Glyph{U'6', "~ 47 48 08 02 42 46 06 04"},
    Glyph{U'7', "- 08 48 12"},
    Glyph{U'8', "o 08 48 45 05 o 05 45 42 02"},
    Glyph{U'9', "~ 03 02 42 48 08 04 44 46"},
    Glyph{U'A', "- 02 28 42 - 14 34"},
    Glyph{U'B', "- 02 08 28 ~ 28 48 45 25 - 05 25 ~ 25 45 42 22 - 02 22"},
    Glyph{U'C', "~ 47 48 08 02 42 43"},
    Glyph{U'D', "- 02 08 18 ~ 18 48 42 12 - 02 12"},
    Glyph{U'E', "- 48 08 02 42 - 05 35"},
    Glyph{U'F', "- 48 08 02 - 05 35"},
    Glyph{U'G', "~ 47 48 08 02 42 44 - 44 45 25"},
    Glyph{U'H', "- 08 02 - 48 42 - 05 45"},
    Glyph{U'I', "- 08 02"},
    Glyph{U'J', "~ 38 33 32 02 03"},
    Glyph{U'K', "- 08 02 - 48 04 - 15 42"},
    Glyph{U'L', "- 08 02 42"},
    Glyph{U'M', "- 02 08 34 68 62"},
    Glyph{U'N', "- 02 08 42 48"},
    Glyph{U'O', "o 08 58 52 02"},
    Glyph{U'P', "- 02 08 28 ~ 28 48 44 24 - 04 24"},
    Glyph{U'Q', "o 08 58 52 02 - 34 51"},
    Glyph{U'R', "- 02 08 28 ~ 28 48 44 24 - 04 24 42"},
    Glyph{U'S', "~ 47 48 08 05 45 42 02 03"},
    Glyph{U'T', "- 08 48 - 28 22"},
    Glyph{U'U', "~ 08 04 02 42 44 48"},
    Glyph{U'V', "- 08 22 48"},
    Glyph{U'W', "- 08 12 37 52 68"},
    Glyph{U'X', "- 08 42 - 48 02"},
    Glyph{U'Y', "- 08 25 48 - 25 22"},
    Glyph{U'Z', "- 08 48 02 42"},
    Glyph{U'a', "o 06 46 42 02 - 46 42"},
    Glyph{U'b', "- 08 02 o 06 46 42 02"},
    Glyph{U'c', "~ 45 46 06 02 42 43"},
    Glyph{U'd', "- 48 42 o 06 46 42 02"},
    Glyph{U'e', "- 04 44 ~ 44 46 06 02 42 43"},
    Glyph{U'f', "~ 38 18 17 12 - 06 26"},
    Glyph{U'g', "o 06 46 42 02 - 46 42 ~ 42 40 00 01"},
    Glyph{U'h', "- 08 02 ~ 04 06 46 44 42"},
    Glyph{U'i', "- 06 02 - 08 08"},
    Glyph{U'j', "~ 16 11 10 00 - 18 18"},
    Glyph{U'k', "- 08 02 - 36 03 - 14 32"},
    Glyph{U'l', "- 08 02"},
    Glyph{U'm', "- 06 02 ~ 04 06 36 34 32 ~ 34 36 66 64 62"},
    Glyph{U'n', "- 06 02 ~ 04 06 46 44 42"},
    Glyph{U'o', "o 06 46 42 02"},
    Glyph{U'p', "- 06 00 o 06 46 42 02"},
    Glyph{U'q', "- 46 40 o 06 46 42 02"},
    Glyph{U'r', "- 06 02 ~ 04 06 26"},
    Glyph{U's', "~ 35 36 06 04 34 32 02 03"},
    Glyph{U't', "~ 18 13 12 32 - 06 26"},
    Glyph{U'u', "~ 06 04 02 42 44 - 46 42"},
    Glyph{U'v', "- 06 22 46"},
    Glyph{U'w', "- 06 12 35 52 66"},
    Glyph{U'x', "- 06 42 - 46 02"},
    Glyph{U'y', "- 06 22 - 46 10"},
    Glyph{U'z', "- 06 46 02 42"},
    Glyph{U'.', "- 02 02"},
    Glyph{U',', "- 02 01"},
    Glyph{U':', "- 02 02 - 05 05"},
    Glyph{U';', "- 02 01 - 05 05"},
    Glyph{U'-', "- 04 34"},
    Glyph{U'\u2013', "- 04 44"},
    Glyph{U'+', "- 04 44 - 26 22"},
    Glyph{U'=', "- 03 43 - 05 45"},
    Glyph{U'/', "- 01 38"},
    Glyph{U'(', "~ 29 07 03 21"},
    Glyph{U')', "~ 09 27 23 01"},
    Glyph{U'%', "o 08 28 25 05 o 45 65 62 42 - 12 58"},
    Glyph{U'\'', "- 08 06"},
    Glyph{U'"', "- 08 06 - 28 26"},
    Glyph{U'_', "- 01 41"},
    Glyph{U'<', "- 36 04 32"},
    Glyph{U'>', "- 06 34 02"},
    Glyph{U'\u2265', "- 07 35 03 - 01 31"},
    Glyph{U'\u2264', "- 37 05 33 - 01 31"},
    Glyph{U'!', "- 08 04 - 02 02"},
    Glyph{U'?', "~ 07 08 48 45 25 24 - 22 22"},
    Glyph{U'\u00b2', "~ 08 09 29 27 05 - 05 25"},
    Glyph{U'\u00b0', "o 08 28 26 06"},
    Glyph{U'\u00b3', "~ 08 09 29 27 17 ~ 17 27 25 05"},
    Glyph{U'\u00b7', "- 04 04"},
    Glyph{U'\u00b1', "- 05 45 - 27 23 - 02 42"},
    Glyph{U'\u2212', "- 04 44"},
    Glyph{U'[', "- 29 09 01 21"},
    Glyph{U']', "- 09 29 21 01"},
    Glyph{U'{', "~ 29 19 16 05 14 11 21"},
    Glyph{U'}', "~ 09 19 16 25 14 11 01"},
    Glyph{U'#', "- 12 18 - 32 38 - 04 44 - 06 46"},
    Glyph{U'&', "~ 53 42 02 05 28 38 07 52"},
    Glyph{U'*', "- 28 24 - 07 45 - 05 47"},
    Glyph{U'|', "- 09 01"},
    Glyph{U'~', "~ 03 05 25 23 43 45"},
    Glyph{U'^', "- 06 28 46"},
    Glyph{U'\\', "- 08 31"},
    Glyph{U'@', "~ 43 45 25 23 43 63 68 08 02 52"},
    Glyph{U'$', "~ 47 48 08 05 45 42 02 03 - 29 21"},
    Glyph{U'`', "- 09 17"},
    Glyph{U'\u00d7', "- 03 36 - 06 33"},
};

constexpr std::string_view kUnknown = "- 02 08 48 42 02";
constexpr double kGap = 1.9;    // between glyphs, grid units
constexpr double kSpace = 3.2;  // width of a blank, grid units
constexpr double kCap = 6.0;    // height of a capital, grid units

// Letters of Latin-1 without their accents, from U+00C0; ' ' where there is none.
constexpr std::u32string_view kBareLetters =
    U"AAAAAAACEEEEIIIIDNOOOOO OUUUUYPsaaaaaaaceeeeiiiidnooooo ouuuuypy";

std::string_view strokes_of(char32_t code) {
  if (code >= 0xc0 && code - 0xc0 < kBareLetters.size() && kBareLetters[code - 0xc0] != U' ') {
    code = kBareLetters[code - 0xc0];
  }
  for (const Glyph& glyph : kGlyphs) {
    if (glyph.code == code) return glyph.strokes;
  }
  return kUnknown;
}

// Corner cutting (Chaikin 1974): tends to the quadratic B-spline of the control points.
Stroke rounded(Stroke points, bool is_closed) {
  for (int round = 0; round < 3; ++round) {
    Stroke finer;
    const std::size_t n = points.size();
    if (!is_closed) finer.push_back(points.front());
    for (std::size_t i = 0; i + (is_closed ? 0 : 1) < n; ++i) {
      const Vec2& a = points[i];
      const Vec2& b = points[(i + 1) % n];
      const bool is_first = !is_closed && i == 0;
      const bool is_last = !is_closed && i + 2 == n;
      if (!is_first) finer.emplace_back(0.75 * a + 0.25 * b);
      if (!is_last) finer.emplace_back(0.25 * a + 0.75 * b);
    }
    if (!is_closed) finer.push_back(points.back());
    points = std::move(finer);
  }
  if (is_closed) points.push_back(points.front());
  return points;
}

std::vector<Stroke> parse(std::string_view text) {
  std::vector<Stroke> strokes;
  std::vector<char> kinds;
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] == ' ') {
      ++i;
    } else if (text[i] >= '0' && text[i] <= '9') {
      strokes.back().emplace_back(text[i] - '0', text[i + 1] - '0');
      i += 2;
    } else {
      kinds.push_back(text[i++]);
      strokes.emplace_back();
    }
  }
  for (std::size_t s = 0; s < strokes.size(); ++s) {
    if (kinds[s] != '-') strokes[s] = rounded(std::move(strokes[s]), kinds[s] == 'o');
  }
  return strokes;
}

double glyph_width(std::string_view strokes) {
  double width = 0.0;
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    // The first digit of a pair is its x.
    if (strokes[i] >= '0' && strokes[i] <= '9') width = std::max<double>(width, strokes[i++] - '0');
  }
  return width;
}

double distance_to_segment(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 ab = b - a;
  const double length2 = ab.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * ab).norm();
}

std::uint8_t blend(std::uint8_t below, std::uint8_t above, double cover) {
  return static_cast<std::uint8_t>(std::lround(below + (above - below) * cover));
}

// Strokes in pixels; each pixel is covered by the nearest stroke, so that crossings don't add up.
void draw_strokes(Image& image, const std::vector<Stroke>& strokes, double width, Rgb colour) {
  Eigen::AlignedBox2d box;
  for (const Stroke& stroke : strokes) {
    for (const Vec2& p : stroke) box.extend(p);
  }
  if (box.isEmpty()) return;
  const double reach = 0.5 * width + 1.0;
  const int x0 = std::max(0, static_cast<int>(std::floor(box.min().x() - reach)));
  const int y0 = std::max(0, static_cast<int>(std::floor(box.min().y() - reach)));
  const int x1 = std::min(image.width - 1, static_cast<int>(std::ceil(box.max().x() + reach)));
  const int y1 = std::min(image.height - 1, static_cast<int>(std::ceil(box.max().y() + reach)));
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const Vec2 p(x + 0.5, y + 0.5);
      double distance = reach;
      for (const Stroke& stroke : strokes) {
        for (std::size_t i = 0; i + 1 < stroke.size(); ++i) {
          distance = std::min(distance, distance_to_segment(p, stroke[i], stroke[i + 1]));
        }
      }
      const double cover = std::clamp(0.5 * width + 0.5 - distance, 0.0, 1.0);
      Rgb& pixel = image.at(x, y);
      pixel = {blend(pixel.r, colour.r, cover), blend(pixel.g, colour.g, cover),
               blend(pixel.b, colour.b, cover)};
    }
  }
}

}  // namespace

std::vector<char32_t> code_points(std::string_view text) {
  std::vector<char32_t> codes;
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const std::size_t length = lead < 0x80 ? 1 : lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : 4;
    char32_t code = length == 1 ? lead : lead & (0xffU >> (length + 1));
    for (std::size_t k = 1; k < length && i + k < text.size(); ++k) {
      code = code << 6 | (static_cast<unsigned char>(text[i + k]) & 0x3fU);
    }
    codes.push_back(code);
    i += length;
  }
  return codes;
}

double text_width(std::string_view text, const TextStyle& style) {
  double width = 0.0;
  for (const char32_t code : code_points(text)) {
    width += code == U' ' ? kSpace : glyph_width(strokes_of(code)) + kGap;
  }
  return std::max(0.0, width - kGap) * style.cap_height / kCap;
}

std::vector<std::vector<Vec2>> text_strokes(std::string_view text, double cap_height) {
  const double scale = cap_height / kCap;
  std::vector<Stroke> result;
  double pen = 0.0;
  for (const char32_t code : code_points(text)) {
    if (code == U' ') {
      pen += kSpace * scale;
      continue;
    }
    const std::string_view glyph = strokes_of(code);
    for (Stroke& stroke : parse(glyph)) {
      for (Vec2& p : stroke) p = Vec2(pen + scale * p.x(), -scale * (p.y() - 2.0));
      result.push_back(std::move(stroke));
    }
    pen += (glyph_width(glyph) + kGap) * scale;
  }
  return result;
}

void draw_text(Image& image, double x, double y, std::string_view text, const TextStyle& style) {
  const double scale = style.cap_height / kCap;
  double pen = x;
  if (style.align != Align::kLeft) {
    pen -= text_width(text, style) * (style.align == Align::kCentre ? 0.5 : 1.0);
  }
  for (const char32_t code : code_points(text)) {
    if (code == U' ') {
      pen += kSpace * scale;
      continue;
    }
    const std::string_view glyph = strokes_of(code);
    std::vector<Stroke> strokes = parse(glyph);
    for (Stroke& stroke : strokes) {
      for (Vec2& p : stroke) p = Vec2(pen + scale * p.x(), y - scale * (p.y() - 2.0));
    }
    draw_strokes(image, strokes, style.weight * style.cap_height, style.colour);
    pen += (glyph_width(glyph) + kGap) * scale;
  }
}

void fill_rectangle(Image& image, int x, int y, int width, int height, Rgb colour) {
  for (int j = std::max(0, y); j < std::min(image.height, y + height); ++j) {
    for (int i = std::max(0, x); i < std::min(image.width, x + width); ++i) {
      image.at(i, j) = colour;
    }
  }
}

}  // namespace palmar::report
