// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/chart/study_charts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/report/words/study_words.h"

namespace palmar::report {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(RoundAxis, HasRoundTicksRoundTheRange) {
  const RoundAxis axis = round_axis(0.127, 0.232);
  EXPECT_DOUBLE_EQ(axis.step, 0.02);
  EXPECT_LE(axis.low, 0.127);
  EXPECT_GE(axis.high, 0.232);
  EXPECT_THAT(axis.text, ElementsAre("0.12", "0.14", "0.16", "0.18", "0.20", "0.22", "0.24"));
  EXPECT_THAT(round_axis(-3.0, 5.0).text, ElementsAre("-4", "-2", "0", "2", "4", "6"));
}

TEST(RoundAxis, WidensARangeOfNoLength) {
  const RoundAxis axis = round_axis(3.0, 3.0);
  EXPECT_LT(axis.low, 3.0);
  EXPECT_GT(axis.high, 3.0);
  EXPECT_GT(round_axis(0.0, 0.0).high, 0.0);
}

DistributionChart chart_of(std::size_t hands) {
  DistributionChart chart{"Peak", "Peak pressure, MPa", {}, {{0, 1, "p < 0.001", true}}};
  for (int s = 0; s < 2; ++s) {
    ChartSample sample{s == 0 ? "old" : "new", product_colour(s), {}};
    for (std::size_t h = 0; h < hands; ++h) {
      sample.values.push_back(0.2 + 0.1 * s + 0.001 * static_cast<double>(h % 37));
    }
    chart.samples.push_back(std::move(sample));
  }
  return chart;
}

std::size_t circles_in(const std::string& svg) {
  std::size_t count = 0;
  for (std::size_t at = svg.find("<circle"); at != std::string::npos; ++count) {
    at = svg.find("<circle", at + 1);
  }
  return count;
}

TEST(DistributionFigure, HasADotPerHandUnitsAndBrackets) {
  const std::string svg = to_svg(distribution_figure(chart_of(30)));
  EXPECT_EQ(circles_in(svg), 60U);
  for (const char* text : {"Peak pressure, MPa", "Share of hands, %", "old (30 hands)",
                           "p &lt; 0.001", "Dot: one hand."}) {
    EXPECT_THAT(svg, HasSubstr(text));
  }
}

TEST(DistributionFigure, OfThousandsOfHandsThinsItsDotsAndSaysSo) {
  const std::string svg = to_svg(distribution_figure(chart_of(5000)));
  EXPECT_LE(circles_in(svg), 2400U);
  EXPECT_THAT(svg, HasSubstr("Dot: every 5th hand."));
  EXPECT_THAT(svg, HasSubstr("(5000 hands)"));
}

TEST(DistributionFigure, WithoutValuesSaysSo) {
  EXPECT_THAT(to_svg(distribution_figure({"Peak", "MPa", {{"a", {}, {}}}, {}})),
              HasSubstr("No hand has a value."));
  EXPECT_THAT(to_svg(trend_figure({"Peak", "mm", "MPa", {}})), HasSubstr("No hand has a value."));
}

TEST(PairWords, SayWhatIsShownAndWhatIsNot) {
  study::StudyPlan plan;
  plan.products.resize(2);
  plan.products[0].name = "old handle";
  plan.products[1].name = "new handle";
  const study::StudyQuantity peak = study::hand_quantities().front();
  study::ProductPair pair;
  pair.second = 1;
  pair.hands = 30;
  pair.pairs = 28;
  pair.mean_first = 0.4;
  pair.mean_second = 0.3;
  pair.t_test.difference = -0.1;
  pair.t_test.interval = {-0.12, -0.08};
  pair.t_p_holm = 2e-5;
  pair.wilcoxon_p_holm = 0.004;
  pair.left_out = {{1, "slips_out", 2}};
  pair.verdict = study::DifferenceVerdict::kShown;
  EXPECT_EQ(pair_words(plan, peak, pair),
            "new handle has a lower peak pressure on sensor cells than old handle: 0.300 against "
            "0.400 MPa, 25 % less (difference 0.100, 95 % interval 0.0800 to 0.120 MPa; 28 of 30 "
            "hands hold both; t-test p < 0.001, Wilcoxon p = 0.004).");
  EXPECT_EQ(left_out_words(plan, pair), "new handle: 2 slips out");
  pair.verdict = study::DifferenceVerdict::kNotShown;
  EXPECT_THAT(pair_words(plan, peak, pair), HasSubstr("No difference"));
  EXPECT_THAT(pair_words(plan, peak, pair), Not(HasSubstr("So few hands")));
  pair.pairs = 5;
  EXPECT_THAT(pair_words(plan, peak, pair), HasSubstr("So few hands prove nothing; 6 or more"));
  pair.pairs = 28;
  pair.verdict = study::DifferenceVerdict::kNone;
  EXPECT_THAT(pair_words(plan, peak, pair), HasSubstr("don't differ"));
  pair.verdict = study::DifferenceVerdict::kTooFewPairs;
  EXPECT_THAT(pair_words(plan, peak, pair), Not(HasSubstr("lower")));
}

}  // namespace
}  // namespace palmar::report
