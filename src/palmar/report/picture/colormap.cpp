// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/picture/colormap.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "palmar/core/error.h"

namespace palmar::report {

namespace {

struct OkLab {
  double L = 0.0, a = 0.0, b = 0.0;
};

struct Linear {
  double r = 0.0, g = 0.0, b = 0.0;
  bool is_displayable() const {
    const auto inside = [](double x) { return x >= 0.0 && x <= 1.0; };
    return inside(r) && inside(g) && inside(b);
  }
};

// Ottosson 2020: OKLab -> cone responses -> linear sRGB.
Linear to_linear(const OkLab& c) {
  const double l = std::pow(c.L + 0.3963377774 * c.a + 0.2158037573 * c.b, 3);
  const double m = std::pow(c.L - 0.1055613458 * c.a - 0.0638541728 * c.b, 3);
  const double s = std::pow(c.L - 0.0894841775 * c.a - 1.2914855480 * c.b, 3);
  return {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
          -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
          -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
}

std::uint8_t to_byte(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  const double srgb = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255.0 * srgb));
}

// A path in OKLCh: lightness and hue run evenly, chroma as asked but no more than a screen shows.
struct Path {
  double lightness_low = 0.0, lightness_high = 1.0;
  double hue_low = 0.0, hue_high = 0.0;  // degrees, may pass 360
  double chroma_low = 0.0, chroma_middle = 0.0, chroma_high = 0.0;
};

OkLab on_path(const Path& path, double t) {
  const double lightness = std::lerp(path.lightness_low, path.lightness_high, t);
  const double hue = std::lerp(path.hue_low, path.hue_high, t) * std::numbers::pi / 180.0;
  const double u = 1.0 - t;  // quadratic through low, middle, high
  double chroma = path.chroma_low * u * (1.0 - 2.0 * t) + path.chroma_middle * 4.0 * u * t +
                  path.chroma_high * t * (2.0 * t - 1.0);
  const auto colour = [&](double c) {
    return OkLab{lightness, c * std::cos(hue), c * std::sin(hue)};
  };
  if (!to_linear(colour(chroma)).is_displayable()) {
    double inside = 0.0;
    double outside = chroma;
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (inside + outside);
      (to_linear(colour(middle)).is_displayable() ? inside : outside) = middle;
    }
    chroma = inside;
  }
  return colour(chroma);
}

// Equal steps of the distance in OKLab along the path.
ColourTable make_table(const Path& path) {
  constexpr int kFine = 4096;
  std::vector<double> length(kFine + 1, 0.0);
  OkLab previous = on_path(path, 0.0);
  for (int i = 1; i <= kFine; ++i) {
    const OkLab now = on_path(path, static_cast<double>(i) / kFine);
    length[static_cast<std::size_t>(i)] =
        length[static_cast<std::size_t>(i - 1)] +
        std::hypot(now.L - previous.L, now.a - previous.a, now.b - previous.b);
    previous = now;
  }
  ColourTable table{};
  for (std::size_t k = 0; k < table.size(); ++k) {
    const double wanted = length.back() * static_cast<double>(k) / (table.size() - 1.0);
    const auto it = std::lower_bound(length.begin(), length.end(), wanted);
    const double t = static_cast<double>(it - length.begin()) / kFine;
    const Linear c = to_linear(on_path(path, std::min(t, 1.0)));
    table[k] = {to_byte(c.r), to_byte(c.g), to_byte(c.b)};
  }
  return table;
}

constexpr Path kEmberPath{.lightness_low = 0.30,
                          .lightness_high = 0.95,
                          .hue_low = 292.0,
                          .hue_high = 465.0,
                          .chroma_low = 0.15,
                          .chroma_middle = 0.215,
                          .chroma_high = 0.12};
constexpr Path kFernPath{.lightness_low = 0.28,
                         .lightness_high = 0.92,
                         .hue_low = 285.0,
                         .hue_high = 105.0,
                         .chroma_low = 0.11,
                         .chroma_middle = 0.12,
                         .chroma_high = 0.18};

// Thumb, index, middle, ring, little: hues of Okabe and Ito (orange, sky blue, green, purple,
// blue), each in three depths from proximal to distal.
constexpr std::array<Rgb, hand::kRegionCount> kRegionColours{{
    {200, 200, 200},                                    // dorsum
    {201, 98, 10},   {246, 173, 72},                    // thumb
    {20, 110, 170},  {86, 180, 233},  {172, 220, 246},  // index
    {0, 105, 78},    {32, 165, 125},  {138, 214, 186},  // middle
    {140, 70, 115},  {204, 121, 167}, {234, 184, 212},  // ring
    {52, 62, 130},   {108, 122, 196}, {182, 190, 234},  // little
    {222, 190, 40},                                     // thenar
    {150, 120, 40},                                     // hypothenar
    {236, 226, 150},                                    // central palm
    {168, 160, 140},                                    // radial palm
    {110, 104, 92},                                     // ulnar palm
}};

}  // namespace

const ColourTable& colour_table(Colormap map) {
  static const ColourTable ember = make_table(kEmberPath);
  static const ColourTable fern = make_table(kFernPath);
  return map == Colormap::kEmber ? ember : fern;
}

Rgb map_colour(Colormap map, double share) {
  const double held = share > 0.0 ? std::min(share, 1.0) : 0.0;
  return colour_table(map)[static_cast<std::size_t>(std::lround(255.0 * held))];
}

std::vector<Rgb> field_colours(std::span<const double> field, double upper, Colormap map,
                               Rgb neutral, double threshold) {
  if (!(upper > 0.0)) {
    throw UsageError("upper end of a colour scale is " + std::to_string(upper) +
                     "; it must be above 0");
  }
  std::vector<Rgb> colours;
  colours.reserve(field.size());
  for (const double value : field) {
    colours.push_back(value > threshold ? map_colour(map, value / upper) : neutral);
  }
  return colours;
}

Rgb region_colour(hand::Region region) { return kRegionColours[static_cast<std::size_t>(region)]; }

}  // namespace palmar::report
