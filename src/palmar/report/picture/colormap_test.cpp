// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/picture/colormap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <tuple>

#include "palmar/core/error.h"
#include "palmar/report/picture/colour_bar.h"

namespace palmar::report {
namespace {

// Relative luminance of sRGB (IEC 61966-2-1).
double luminance(Rgb c) {
  const auto linear = [](double byte) {
    const double s = byte / 255.0;
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(c.r) + 0.7152 * linear(c.g) + 0.0722 * linear(c.b);
}

// CIE L*, another measure of lightness than the one the maps are made with.
double cie_lightness(Rgb c) {
  const double y = luminance(c);
  return y > 216.0 / 24389.0 ? 116.0 * std::cbrt(y) - 16.0 : y * 24389.0 / 27.0;
}

TEST(Colormap, LightnessRisesAllTheWay) {
  for (const Colormap map : {Colormap::kEmber, Colormap::kFern}) {
    const ColourTable& table = colour_table(map);
    EXPECT_LT(cie_lightness(table.front()), 32.0);
    EXPECT_GT(cie_lightness(table.back()), 85.0);
    for (std::size_t i = 8; i < table.size(); i += 8) {
      EXPECT_GT(cie_lightness(table[i]), cie_lightness(table[i - 8])) << i;
    }
  }
}

TEST(Colormap, ValuesOutsideAreHeldAtTheEnds) {
  const ColourTable& table = colour_table(Colormap::kEmber);
  EXPECT_EQ(map_colour(Colormap::kEmber, -1.0), table.front());
  EXPECT_EQ(map_colour(Colormap::kEmber, 2.0), table.back());
  EXPECT_EQ(map_colour(Colormap::kEmber, std::numeric_limits<double>::quiet_NaN()), table.front());
  EXPECT_EQ(map_colour(Colormap::kEmber, 1.0 / 3.0), table[85]);
}

TEST(FieldColours, NothingIsNeutralAndTheUpperEndIsTheLastColour) {
  const std::vector<double> field{0.0, 0.2, 0.4};
  const auto colours = field_colours(field, 0.4, Colormap::kEmber);
  EXPECT_EQ(colours[0], kNeutralColour);
  EXPECT_EQ(colours[2], colour_table(Colormap::kEmber).back());
  EXPECT_THROW(field_colours(field, 0.0, Colormap::kEmber), UsageError);
}

TEST(RegionColour, TwentyRegionsHaveTwentyColours) {
  std::set<std::tuple<int, int, int>> seen;
  for (int i = 0; i < hand::kRegionCount; ++i) {
    const Rgb c = region_colour(static_cast<hand::Region>(i));
    seen.insert({c.r, c.g, c.b});
  }
  EXPECT_EQ(seen.size(), 20U);
}

TEST(ColourBar, ScaleEndsAtARoundNumberAboveThePeak) {
  EXPECT_DOUBLE_EQ(rounded_up(0.262), 0.3);
  EXPECT_DOUBLE_EQ(rounded_up(0.3), 0.3);
  EXPECT_DOUBLE_EQ(rounded_up(1.01), 1.5);
  EXPECT_DOUBLE_EQ(rounded_up(9.1), 10.0);
  EXPECT_THROW(rounded_up(0.0), UsageError);
  EXPECT_EQ(ticks_to(0.3).text,
            (std::vector<std::string>{"0.00", "0.05", "0.10", "0.15", "0.20", "0.25", "0.30"}));
  EXPECT_EQ(ticks_to(6.0).text.back(), "6");
}

}  // namespace
}  // namespace palmar::report
