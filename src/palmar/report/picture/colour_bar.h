// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/report/picture/colormap.h"

namespace palmar::report {

/// What the colours of a picture mean: a map from 0 to `upper`.
struct ColourScale {
  Colormap map = Colormap::kEmber;
  double upper = 1.0;            ///< value at the top of the bar, in `unit`
  std::string quantity;          ///< "Pressure"
  std::string unit;              ///< "MPa"
  Rgb neutral = kNeutralColour;  ///< nothing there
  bool is_open_ended = false;    ///< some values are above `upper` and shown in its colour
  std::string none = "none";     ///< what the swatch of the neutral colour is called
};

/// A number above 0 rounded up to 1, 1.5, 2, 2.5, 3, 4, 5, 6, 8 x 10^n: end of a readable scale.
double rounded_up(double value);

/// Tick values from 0 to `upper` at a round step, 4 to 9 of them; their texts with just the
/// decimals that the step needs.
struct Ticks {
  std::vector<double> value;
  std::vector<std::string> text;
};
Ticks ticks_to(double upper);
/// Those of a scale; the text at an open end is "≥ 0.25".
Ticks ticks_of(const ColourScale& scale);

/// Draws the bar with ticks, quantity and unit along the right edge of a picture, and a swatch that
/// says which colour means no contact.
void draw_colour_bar(Image& image, const ColourScale& scale);

/// Width that draw_colour_bar() takes at the right edge, pixels.
int colour_bar_width(int image_height);

}  // namespace palmar::report
