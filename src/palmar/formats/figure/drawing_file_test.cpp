// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/figure/drawing_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <utility>

#include "palmar/core/error.h"

namespace palmar::formats {
namespace {

Drawing drawing() {
  Drawing d;
  d.title = "handle <1> & co";
  d.layers = {{"outline palm é", {44, 92, 178}, 5, 0.35, false},
              {"centre", {90, 90, 90}, 8, 0.15, true}};
  d.lines = {{0, {{0, 0}, {110, 0}, {110, 130}, {0, 130}}, true},
             {1, {{55, -4}, {55, 134}}, false}};
  d.texts = {{1, {0, -8}, 3.0, "2 < 3"}};
  return d;
}

/// Pairs of group code and value, as the DXF reference lays them out.
std::vector<std::pair<int, std::string>> pairs_of(const std::string& dxf) {
  std::vector<std::pair<int, std::string>> pairs;
  std::istringstream in(dxf);
  for (std::string code, value; std::getline(in, code) && std::getline(in, value);) {
    pairs.emplace_back(std::stoi(code), value);
  }
  return pairs;
}

TEST(Dxf, HoldsPolylinesOfTheRightLengthsOnTheirLayers) {
  const auto pairs = pairs_of(dxf_of(drawing()));
  ASSERT_FALSE(pairs.empty());
  EXPECT_EQ(pairs.back(), std::pair(0, std::string("EOF")));
  int polylines = 0, vertices = 0, closed = 0, open_sections = 0;
  std::vector<double> x, y;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto& [code, value] = pairs[i];
    if (code == 0 && value == "SECTION") ++open_sections;
    if (code == 0 && value == "ENDSEC") --open_sections;
    if (code == 0 && value == "POLYLINE") {
      ++polylines;
      EXPECT_EQ(pairs[i + 1].first, 8);
      if (polylines == 1) {
        EXPECT_EQ(pairs[i + 1].second, "OUTLINE_PALM__");
      }
      for (std::size_t k = i + 1; pairs[k].first != 0; ++k) {
        if (pairs[k] == std::pair(70, std::string("1"))) ++closed;
      }
    }
    if (code == 0 && value == "VERTEX") {
      ++vertices;
      x.push_back(std::stod(pairs[i + 2].second));
      y.push_back(std::stod(pairs[i + 3].second));
    }
  }
  EXPECT_EQ(open_sections, 0);
  EXPECT_EQ(polylines, 2);
  EXPECT_EQ(closed, 1);
  ASSERT_EQ(vertices, 6);
  EXPECT_NEAR(std::hypot(x[1] - x[0], y[1] - y[0]), 110.0, 1e-6);
  EXPECT_NEAR(std::hypot(x[5] - x[4], y[5] - y[4]), 138.0, 1e-6);
}

TEST(Svg, IsInTrueScale) {
  const std::string svg = svg_of(drawing());
  // 110 mm and the text's 8 mm below, 134 above; 5 mm of paper around.
  EXPECT_THAT(svg, testing::HasSubstr("width=\"120.000mm\" height=\"152.000mm\" "
                                      "viewBox=\"0 0 120.000 152.000\""));
  EXPECT_THAT(svg, testing::HasSubstr("<title>handle &lt;1&gt; &amp; co</title>"));
  EXPECT_THAT(svg, testing::HasSubstr("stroke-dasharray"));
  EXPECT_THAT(svg, testing::HasSubstr("2 &lt; 3</text>"));
}

TEST(Drawing, RefusesWhatIsntThere) {
  Drawing d = drawing();
  d.lines[0].layer = 2;
  EXPECT_THAT([&] { dxf_of(d); }, testing::ThrowsMessage<UsageError>("drawing: layer 2; it has 2"));
  d = drawing();
  d.lines[0].points[0].x() = std::nan("");
  EXPECT_THROW(svg_of(d), UsageError);
}

}  // namespace
}  // namespace palmar::formats
