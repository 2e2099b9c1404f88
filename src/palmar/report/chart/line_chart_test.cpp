// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/chart/line_chart.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "palmar/report/chart/press_chart.h"

namespace palmar::report {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

int count_of(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(LineChart, HasATitleLabelsWithUnitsAndAMarkPerPoint) {
  const LineChart chart{
      "Force <of> a finger", "Depth, mm", "Force, N", {{"", {{1, 0.5}, {2, 3}, {3, 7.5}}}}};
  const std::string svg = svg_line_chart(chart);
  EXPECT_THAT(svg, AllOf(HasSubstr("Force &lt;of&gt; a finger"), HasSubstr(">Depth, mm<"),
                         HasSubstr(">Force, N<")));
  EXPECT_EQ(count_of(svg, "<circle"), 3);
  EXPECT_EQ(svg, svg_line_chart(chart));
}

TEST(LineChart, PutsPointsWhereTheAxesSay) {
  // The largest values, 2 and 8, are the ends of both axes: the last point stands in the corner.
  const std::string svg = svg_line_chart({"", "x", "y", {{"", {{2, 8}, {0, 0}, {1, 4}}}}});
  std::smatch match;
  const std::regex pattern(R"re(points="([\d.]+),([\d.]+) ([\d.]+),([\d.]+) ([\d.]+),([\d.]+)")re");
  ASSERT_TRUE(std::regex_search(svg, match, pattern));
  const auto at = [&](int i) { return std::stod(match[static_cast<std::size_t>(i)]); };
  EXPECT_LT(at(1), at(3));  // joined in the order of x
  EXPECT_LT(at(3), at(5));
  EXPECT_NEAR(at(3), 0.5 * (at(1) + at(5)), 0.1);  // pixels; printed to a tenth
  EXPECT_NEAR(at(4), 0.5 * (at(2) + at(6)), 0.1);
  EXPECT_GT(at(2), at(6));  // y points up
}

TEST(LineChart, LeavesOutWhatIsNotFinite) {
  const std::string svg =
      svg_line_chart({"", "x", "y", {{"", {{1, std::nan("")}, {2, INFINITY}, {3, 4}}}}});
  EXPECT_EQ(count_of(svg, "<circle"), 1);
  EXPECT_THAT(svg, AllOf(Not(HasSubstr("nan")), Not(HasSubstr("inf"))));
}

TEST(LineChart, SaysThatThereIsNothing) {
  EXPECT_THAT(svg_line_chart({"Force", "x", "y", {}}), HasSubstr("No values."));
}

TEST(LineChart, ALegendNamesSeveralSeries) {
  const std::string svg =
      svg_line_chart({"", "x", "y", {{"half-space", {{1, 1}}}, {"layered", {{1, 2}}}}});
  EXPECT_THAT(svg, AllOf(HasSubstr(">half-space<"), HasSubstr(">layered<")));
}

TEST(PressChart, ShowsForceAreaAndPressureAgainstDepth) {
  contact::PressStep step;
  step.depth = 1.0;
  step.force = 2.0;
  step.area = 30.0;
  step.peak_pressure = 0.1;
  const std::string svg = press_chart({step}, "plane pressed by sphere:5");
  EXPECT_THAT(svg, AllOf(HasSubstr("plane pressed by sphere:5"), HasSubstr(">Force, N<"),
                         HasSubstr(">Contact area, mm\u00b2<"), HasSubstr(">Pressure, MPa<")));
  EXPECT_EQ(count_of(svg, ">Depth, mm<"), 3);
  EXPECT_EQ(count_of(svg, "<svg"), 1);
}

}  // namespace
}  // namespace palmar::report
