// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/chart/figure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/report/chart/axis.h"
#include "palmar/report/chart/correlation_chart.h"
#include "palmar/report/chart/helvetica.h"
#include "palmar/report/chart/scatter_chart.h"
#include "palmar/report/picture/coverage_mask.h"

namespace palmar::report {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// Area that black covers on white, pixels.
double dark_area(const Image& image) {
  double sum = 0.0;
  for (const Rgb& p : image.pixels) sum += 1.0 - p.g / 255.0;
  return sum;
}

// Shares of 1/255 per pixel on the rim are lost to rounding.
constexpr double kRounding = 0.3;  // pixels, of shapes as small as these

TEST(CoverageMask, CoversTheAreaOfShapes) {
  Image image(40, 40);
  CoverageMask mask(40, 40);
  const std::vector<Eigen::Vector2d> triangle{{3.3, 2.7}, {30.1, 8.2}, {12.6, 33.9}};
  mask.add_polygon(triangle);
  mask.paint(image, kBlack, 1.0);
  const Eigen::Vector2d a = triangle[1] - triangle[0];
  const Eigen::Vector2d b = triangle[2] - triangle[0];
  EXPECT_NEAR(dark_area(image), 0.5 * (a.x() * b.y() - a.y() * b.x()), kRounding);
  EXPECT_EQ(image.at(15, 12), kBlack);
  EXPECT_EQ(image.at(1, 1), kWhite);
  // The mask is empty again.
  Image second(40, 40);
  mask.paint(second, kBlack, 1.0);
  EXPECT_EQ(dark_area(second), 0.0);
}

TEST(CoverageMask, CutsOffWhatLiesOutside) {
  Image image(10, 10);
  CoverageMask mask(10, 10);
  // A square turned by 45 degrees about the lower right corner: a quarter of it lies inside.
  mask.add_polygon(std::vector<Eigen::Vector2d>{{10, 4}, {16, 10}, {10, 16}, {4, 10}});
  mask.paint(image, kBlack, 1.0);
  EXPECT_NEAR(dark_area(image), 18.0, kRounding);
  mask.add_polygon(std::vector<Eigen::Vector2d>{{-50, -50}, {60, -50}, {60, 60}, {-50, 60}});
  mask.paint(image, kBlack, 1.0);
  EXPECT_NEAR(dark_area(image), 100.0, 1e-9);
}

TEST(Figure, PixelsCoverTheAreasOfItsShapes) {
  Figure disk(60, 40);
  disk.circle(30.2, 20.4, 12.5, Fill{kBlack});
  EXPECT_NEAR(dark_area(to_image(disk, 2.0)), 4 * std::numbers::pi * 12.5 * 12.5, 4.0);
  Figure half(60, 40);
  half.rect(10, 10, 20, 10, Fill{kBlack, 0.5});
  EXPECT_NEAR(dark_area(to_image(half, 1.0)), 100.0, 1.0);
  Figure line(60, 40);
  line.line(5, 5, 35, 25, {kBlack, 3.0});
  EXPECT_NEAR(dark_area(to_image(line, 1.0)), 3.0 * std::hypot(30.0, 20.0), 1.0);
  Figure dashes(60, 40);
  dashes.line(5, 20, 45, 20, {kBlack, 2.0, 4.0});
  EXPECT_NEAR(dark_area(to_image(dashes, 1.0)), 0.5 * 2.0 * 40.0, 1.0);
  Figure frame(60, 40);
  frame.rect(10, 10, 20, 10, std::nullopt, Pen{kBlack, 2.0});
  EXPECT_NEAR(dark_area(to_image(frame, 1.0)), 22.0 * 12.0 - 18.0 * 8.0, 2.0);
}

TEST(Figure, TextTakesThePlaceOfHelvetica) {
  // Adobe's metrics: H 722, a 556, n 556, d 556 of 1000.
  EXPECT_NEAR(text_width("Hand", {.size = 10.0}), 23.9, 1e-12);
  EXPECT_NEAR(text_width("Hand", {.size = 10.0, .is_bold = true}), 7.22 + 5.56 + 2 * 6.11, 1e-12);
  Figure figure(100, 40);
  figure.text(90, 30, "Hand", {.size = 20.0, .align = Align::kRight, .colour = kBlack});
  const Image image = to_image(figure, 1.0);
  int left = 100, right = 0;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 100; ++x) {
      if (image.at(x, y).g > 128) continue;
      left = std::min(left, x);
      right = std::max(right, x);
    }
  }
  EXPECT_NEAR(left, 90 - 47.8, 2.0);
  EXPECT_NEAR(right, 89, 2.0);
}

TEST(Figure, SvgEscapesTextAndStandsAlone) {
  Figure figure(100, 50, "A < B & \"C\"");
  figure.text(10, 20, "<b>&\x01");
  figure.polyline({{1, 2}, {3.456, -0.001}});
  const std::string svg = to_svg(figure);
  EXPECT_THAT(svg, StartsWith("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 100 50\""));
  EXPECT_THAT(svg, HasSubstr("aria-label=\"A &lt; B &amp; &quot;C&quot;\""));
  EXPECT_THAT(svg, HasSubstr("&lt;b&gt;&amp;"));
  EXPECT_THAT(svg, HasSubstr("points=\"1,2 3.46,0\""));
  EXPECT_THAT(svg, Not(HasSubstr("<script")));
  EXPECT_EQ(svg, to_svg(figure));
}

TEST(Figure, PdfHasItsObjectsWhereItsTableSaysAndNoDate) {
  Figure figure(120, 80, "T (1)");
  figure.rect(0, 0, 120, 80, Fill{kWhite});
  figure.circle(60, 40, 20, Fill{{200, 0, 0}, 0.5}, Pen{});
  figure.text(60, 40, "5 \xE2\x89\xA5 4 \xC2\xB1 1", {.align = Align::kCentre, .turn = 30.0});
  figure.image(10, 10, 20, 20, Image(3, 2));
  const std::string pdf = to_pdf(figure);
  EXPECT_THAT(pdf, StartsWith("%PDF-1.4\n"));
  EXPECT_THAT(pdf, HasSubstr("/MediaBox [0 0 120 80]"));
  EXPECT_THAT(pdf, HasSubstr("/Title (T \\(1\\))"));
  EXPECT_THAT(pdf, Not(HasSubstr("Date")));
  const std::size_t start = std::stoul(pdf.substr(pdf.rfind("startxref") + 10));
  ASSERT_EQ(pdf.substr(start, 5), "xref\n");
  const std::size_t entries = pdf.find("f \n", start) + 3;
  for (int object = 1; object <= 8; ++object) {
    const std::size_t at = std::stoul(pdf.substr(entries + 20 * (object - 1), 10));
    EXPECT_EQ(pdf.substr(at, 7), std::to_string(object) + " 0 obj");
  }
  EXPECT_EQ(pdf, to_pdf(figure));
}

TEST(Figure, BadShapesAndSizesAreNamed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Figure figure(10, 10);
  EXPECT_THROW(figure.line(0, nan, 1, 1), UsageError);
  EXPECT_THROW(figure.circle(0, 0, nan, Fill{}), UsageError);
  EXPECT_THROW(figure.text(nan, 0, "x"), UsageError);
  EXPECT_THROW(Figure(0, 10), UsageError);
  EXPECT_THROW(Figure(10, 6000), UsageError);
  EXPECT_THROW(to_image(figure, 1e6), UsageError);
  EXPECT_THROW(to_image(figure, nan), UsageError);
  figure.add(figure, 1, 1);
  EXPECT_TRUE(figure.shapes().empty());
}

TEST(WinAnsi, KeepsLatinLettersAndReplacesOthers) {
  EXPECT_EQ(win_ansi("Gr\xC3\xB6\xC3\x9F"
                     "e"),
            "Gr\xF6\xDF"
            "e");
  EXPECT_EQ(win_ansi("\xE2\x89\xA5 \xCF\x81 \xE4\xB8\xAD"), ">= rho ?");
}

TEST(Axis, TakesInAllValuesAtRoundTicks) {
  const Axis axis = axis_over(164.0, 239.0);
  EXPECT_THAT(axis.texts, ElementsAre("160", "180", "200", "220", "240"));
  EXPECT_EQ(axis.share(200.0), 0.5);
  EXPECT_THAT(axis_over(-0.1, 0.22, 4).texts, ElementsAre("-0.1", "0.0", "0.1", "0.2", "0.3"));
  const Axis one = axis_over(5.0, 5.0);
  EXPECT_LT(one.low, 5.0);
  EXPECT_GT(one.high, 5.0);
  EXPECT_LT(axis_over(0.0, 0.0).low, 0.0);
  EXPECT_GT(axis_over(0.0, 1e-7).ticks.size(), 3U);
}

TEST(ScatterChart, DrawsEveryPlaceOnceAndTheEquation) {
  ScatterChart chart;
  chart.title = "Palm length on hand length";
  chart.x_label = "hand length, mm";
  chart.y_label = "palm length, mm";
  ScatterSeries series;
  series.points = {{180, 100}, {180, 100}, {190, 110}, {NAN, 3}, {200, 108}};
  series.line = {{180, 200}, {101, 111}, {99, 109}, {103, 113}, {90, 100}, {112, 122}};
  chart.series = {series};
  chart.notes = {"y = 1 + 0.5 x"};
  const Figure figure = scatter_chart(chart);
  int circles = 0;
  for (const Figure::Shape& shape : figure.shapes()) {
    circles += std::holds_alternative<Figure::Circle>(shape) ? 1 : 0;
  }
  EXPECT_EQ(circles, 3);
  EXPECT_THAT(to_svg(figure), HasSubstr("y = 1 + 0.5 x"));
  EXPECT_THAT(to_svg(scatter_chart({})), HasSubstr("No values."));
}

TEST(CorrelationChart, ColoursTheLowerTriangle) {
  CorrelationChart chart;
  chart.title = "r";
  chart.names = {"a", "b", "c"};
  chart.r = Eigen::Matrix3d{{1, 1, -1}, {1, 1, 0}, {-1, 0, 1}};
  chart.is_significant.setConstant(3, 3, true);
  const std::string svg = to_svg(correlation_chart(chart));
  EXPECT_THAT(svg, HasSubstr("#c85500"));  // +1
  EXPECT_THAT(svg, HasSubstr("#005aa0"));  // -1
  EXPECT_THAT(svg, HasSubstr("-1.00"));
  chart.names.pop_back();
  EXPECT_THROW(correlation_chart(chart), UsageError);
}

}  // namespace
}  // namespace palmar::report
