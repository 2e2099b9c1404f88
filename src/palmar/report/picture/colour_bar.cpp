// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/picture/colour_bar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "palmar/core/error.h"
#include "palmar/report/picture/stroke_text.h"

namespace palmar::report {

namespace {

// Sizes follow the picture's height; 700 pixels are the design size.
double scale_of(int image_height) { return std::clamp(image_height / 700.0, 0.35, 6.0); }

}  // namespace

double rounded_up(double value) {
  if (!(value > 0.0) || !std::isfinite(value)) {
    throw UsageError("colour scale: upper end is " + std::to_string(value) +
                     "; a number above 0 is required");
  }
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0}) {
    if (value <= step * power * (1.0 + 1e-9)) return step * power;
  }
  return 10.0 * power;
}

Ticks ticks_to(double upper) {
  double power = std::pow(10.0, std::floor(std::log10(upper)) - 1.0);
  double step = power;
  int decimals = 0;
  for (const double candidate : {1.0, 2.0, 2.5, 5.0, 10.0, 20.0, 25.0, 50.0}) {
    step = candidate * power;
    if (upper / step <= 7.0 + 1e-9) {
      const bool has_half = candidate == 2.5;
      const double exponent = std::floor(std::log10(step) + 1e-9);
      decimals = std::max(0, -static_cast<int>(exponent) + (has_half || candidate == 25.0 ? 1 : 0));
      break;
    }
  }
  Ticks ticks;
  for (int i = 0; i * step <= upper * (1.0 + 1e-9); ++i) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.*f", decimals, i * step);
    ticks.value.push_back(i * step);
    ticks.text.emplace_back(text.data());
  }
  return ticks;
}

Ticks ticks_of(const ColourScale& scale) {
  Ticks ticks = ticks_to(scale.upper);
  if (scale.is_open_ended) ticks.text.back() = "\u2265 " + ticks.text.back();
  return ticks;
}

int colour_bar_width(int image_height) {
  return static_cast<int>(std::lround(118.0 * scale_of(image_height)));
}

void draw_colour_bar(Image& image, const ColourScale& scale) {
  const double s = scale_of(image.height);
  const auto px = [&](double x) { return static_cast<int>(std::lround(x * s)); };
  const int left = image.width - colour_bar_width(image.height) + px(10);
  const int width = px(22);
  const int top = px(110);
  const int bottom = image.height - px(96);
  TextStyle title{.cap_height = 11.0 * s, .weight = 0.15};
  const TextStyle label{.cap_height = 10.0 * s};
  const Rgb frame{120, 126, 132};
  // Long names are written smaller rather than cut off at the picture's edge.
  const double room = image.width - left - px(4);
  const double needed = text_width(scale.quantity, title);
  if (needed > room) title.cap_height *= room / needed;
  draw_text(image, left, top - px(34), scale.quantity, title);
  draw_text(image, left, top - px(14), scale.unit, label);
  fill_rectangle(image, left - 1, top - 1, width + 2, bottom - top + 2, frame);
  for (int y = top; y < bottom; ++y) {
    const double share = (bottom - 0.5 - y) / (bottom - top);
    fill_rectangle(image, left, y, width, 1, map_colour(scale.map, share));
  }
  const Ticks ticks = ticks_of(scale);
  for (std::size_t i = 0; i < ticks.value.size(); ++i) {
    const int y =
        static_cast<int>(std::lround(bottom - (bottom - top) * ticks.value[i] / scale.upper));
    fill_rectangle(image, left + width, y, px(5), std::max(1, px(1)), frame);
    draw_text(image, left + width + px(10), y + 5.0 * s, ticks.text[i], label);
  }
  const int swatch = bottom + px(24);
  fill_rectangle(image, left - 1, swatch - 1, width + 2, px(14) + 2, frame);
  fill_rectangle(image, left, swatch, width, px(14), scale.neutral);
  draw_text(image, left + width + px(8), swatch + px(12), scale.none, label);
}

}  // namespace palmar::report
