// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/population/table_statistics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "palmar/core/error.h"
#include "palmar/formats/test_files.h"
#include "palmar/population/table_population.h"
#include "palmar/records/population/dimension_table_file.h"
#include "palmar/records/population/population_file.h"

namespace palmar::records {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

population::DimensionTable parsed_table(const std::string& text) {
  return parse_dimension_table(text, "t.csv");
}

/// The survey's own table, which isn't part of the repository.
const population::DimensionTable* ansur2() {
  static const std::string path =
      std::string(PALMAR_SHARED_DIR) + "/reference/anatomy/ansur2_hand.csv";
  static const std::optional<population::DimensionTable> table =
      std::filesystem::exists(path) ? std::optional(read_dimension_table(path)) : std::nullopt;
  return table ? &*table : nullptr;
}
#define NEED_ANSUR2()                                                   \
  if (ansur2() == nullptr)                                              \
  GTEST_SKIP() << "../shared/reference/anatomy/ansur2_hand.csv is not " \
                  "here"

std::vector<population::TableGroup> by_sex() {
  std::vector<std::string> notes;
  return population::grouped(*ansur2(), "sex", notes);
}

// Figures of the next three tests: ANSUR II public data (Gordon et al. 2014, 2012 Anthropometric
// Survey of U.S. Army Personnel), computed by others from the public files and published with so
// many digits; half of the last one is the tolerance.
struct Published {
  const char* group;
  const char* dimension;
  int n;
  double mean, sd, min, p1, p5, p25, p50, p75, p95, p99, max, skewness, kurtosis;
};

TEST(TableStatistics, DescribesTheSurveyAsPublished) {
  NEED_ANSUR2();
  const Published figures[] = {{"M", "hand_length", 4082, 193.28, 9.946, 164, 172.0, 177.0, 187.0,
                                193.0, 200.0, 210.0, 218.0, 239, 0.225, 0.289},
                               {"M", "hand_width", 4082, 88.26, 4.388, 74, 78.0, 81.0, 85.0, 88.0,
                                91.0, 96.0, 99.0, 105, 0.140, 0.104},
                               {"M", "hand_circumference", 4082, 212.28, 10.243, 179, 189.0, 195.0,
                                206.0, 212.0, 219.0, 230.0, 237.0, 248, 0.078, -0.004},
                               {"M", "wrist_circumference", 4082, 175.92, 8.955, 141, 156.0, 162.0,
                                170.0, 176.0, 182.0, 191.0, 198.0, 216, 0.187, 0.334},
                               {"F", "hand_length", 1986, 181.08, 10.056, 145, 160.0, 165.0, 174.0,
                                180.0, 187.0, 199.0, 207.0, 220, 0.320, 0.312},
                               {"F", "hand_width", 1986, 78.15, 3.843, 67, 69.8, 72.0, 75.0, 78.0,
                                80.0, 85.0, 87.0, 92, 0.164, 0.071},
                               {"F", "palm_length", 1986, 108.70, 5.940, 88, 96.0, 100.0, 105.0,
                                108.0, 113.0, 119.0, 124.0, 130, 0.331, 0.111},
                               {"F", "wrist_circumference", 1986, 154.79, 7.828, 124, 138.0, 142.2,
                                150.0, 154.0, 160.0, 168.0, 174.0, 183, 0.248, 0.203}};
  for (const Published& p : figures) {
    const population::DimensionTable part =
        population::where(*ansur2(), std::string("sex=") + p.group);
    const population::ColumnDescription d = population::describe(part, {p.dimension}).front();
    SCOPED_TRACE(std::string(p.group) + " " + p.dimension);
    EXPECT_EQ(d.summary->n, p.n);
    EXPECT_EQ(d.missing, 0);
    EXPECT_NEAR(d.summary->mean, p.mean, 0.0051);
    EXPECT_NEAR(d.summary->sd, p.sd, 0.00051);
    EXPECT_EQ(d.summary->min, p.min);
    EXPECT_EQ(d.summary->max, p.max);
    const double percentiles[] = {p.p1, p.p5, p.p25, p.p50, p.p75, p.p95, p.p99};
    for (std::size_t i = 0; i < 7; ++i) EXPECT_NEAR(d.percentiles[i], percentiles[i], 0.051);
    // Published are g1 and g2 without the correction for n (Joanes & Gill 1998).
    const double n = p.n;
    const double g1 = *d.summary->skewness * (n - 2) / std::sqrt(n * (n - 1));
    const double g2 = (*d.summary->excess_kurtosis * (n - 2) * (n - 3) / (n - 1) - 6) / (n + 1);
    EXPECT_NEAR(g1, p.skewness, 0.00051);
    EXPECT_NEAR(g2, p.kurtosis, 0.00051);
  }
}

TEST(TableStatistics, CorrelatesTheSurveyAsPublished) {
  NEED_ANSUR2();
  struct Pair {
    const char* group;
    const char* a;
    const char* b;
    double r, low, high;
  };
  const Pair figures[] = {
      {"M", "hand_length", "hand_width", 0.5817, 0.5610, 0.6016},
      {"M", "hand_length", "hand_circumference", 0.5905, 0.5701, 0.6101},
      {"M", "hand_width", "hand_circumference", 0.9217, 0.9170, 0.9262},
      {"M", "palm_length", "wrist_circumference", 0.4686, 0.4443, 0.4922},
      {"F", "hand_length", "hand_circumference", 0.5623, 0.5315, 0.5916},
      {"F", "hand_length", "palm_length", 0.8387, 0.8252, 0.8513},
      {"F", "hand_circumference", "wrist_circumference", 0.7375, 0.7168, 0.7569},
      {"", "hand_length", "hand_circumference", 0.7036, 0.6906, 0.7160},
      {"", "hand_width", "hand_circumference", 0.9630, 0.9611, 0.9648}};
  for (const Pair& p : figures) {
    const population::DimensionTable part =
        *p.group == '\0' ? *ansur2() : population::where(*ansur2(), std::string("sex=") + p.group);
    const population::TableCorrelation c = population::correlate(part, {p.a, p.b});
    ASSERT_THAT(c.pairs, SizeIs(1));
    EXPECT_NEAR(c.pairs[0].pearson.r, p.r, 0.000051) << p.group << p.a << p.b;
    EXPECT_NEAR(c.pairs[0].pearson.interval->low, p.low, 0.000051);
    EXPECT_NEAR(c.pairs[0].pearson.interval->high, p.high, 0.000051);
    EXPECT_LT(c.pairs[0].pearson.p_value, 1e-100);
  }
}

TEST(TableStatistics, RegressesTheSurveyAsPublished) {
  NEED_ANSUR2();
  struct Line {
    const char* group;
    const char* dimension;
    std::vector<double> slopes;  // on hand_length, hand_circumference; 0: not in it
    double intercept, r2, rmse;
  };
  const Line figures[] = {{"M", "hand_width", {0.25660, 0.0}, 38.666, 0.3383, 3.570},
                          {"M", "hand_width", {0.0, 0.39485}, 4.441, 0.8495, 1.702},
                          {"M", "hand_width", {0.02533, 0.38033}, 2.629, 0.8517, 1.690},
                          {"M", "palm_length", {0.49788, 0.0}, 20.227, 0.6313, 3.785},
                          {"F", "palm_length", {0.47898, 0.03338}, 15.736, 0.7051, 3.227},
                          {"F", "wrist_circumference", {0.0, 0.65452}, 32.691, 0.5439, 5.288},
                          {"", "hand_width", {0.0, 0.39301}, 4.835, 0.9274, 1.710}};
  const char* names[] = {"hand_length", "hand_circumference"};
  for (const Line& line : figures) {
    const population::DimensionTable part =
        *line.group == '\0' ? *ansur2()
                            : population::where(*ansur2(), std::string("sex=") + line.group);
    std::vector<std::string> predictors;
    for (std::size_t k = 0; k < 2; ++k) {
      if (line.slopes[k] != 0.0) predictors.emplace_back(names[k]);
    }
    const population::TableRegression r =
        population::regress(part, predictors, {line.dimension}).back();
    SCOPED_TRACE(std::string(line.group) + " " + line.dimension);
    ASSERT_EQ(r.predictors, predictors);
    EXPECT_NEAR(r.fit.intercept.estimate, line.intercept, 0.00051);
    std::size_t used = 0;
    for (const double slope : line.slopes) {
      if (slope == 0.0) continue;
      EXPECT_NEAR(r.fit.slopes[used++].estimate, slope, 0.0000051);
    }
    EXPECT_NEAR(r.fit.r2, line.r2, 0.000051);
    EXPECT_NEAR(r.fit.residual_sd, line.rmse, 0.0011);  // published over n, ours over n - 1 - k
  }
  const auto all = population::regress(population::where(*ansur2(), "sex=M"),
                                       population::usual_predictors(*ansur2()));
  const auto best = [&](const char* name) {
    return all[population::best_predictor(all, name)].predictors[0];
  };
  EXPECT_EQ(best("hand_width"), "hand_circumference");
  EXPECT_EQ(best("palm_length"), "hand_length");
}

TEST(TablePopulation, OfTheSurveyKeepsItsMoments) {
  NEED_ANSUR2();
  const population::Population population = population::population_of_table(
      by_sex(), {"hand_length", "hand_circumference"}, "survey", "The survey");
  ASSERT_THAT(population.strata, SizeIs(2));
  const population::Stratum& women = population.strata[0];
  EXPECT_EQ(women.sex, grasp::Sex::kFemale);
  EXPECT_NEAR(women.share, 1986.0 / 6068.0, 1e-12);
  EXPECT_NEAR(women.driving[0].mean, 181.08, 0.0051);
  EXPECT_NEAR(women.correlation(0, 1), 0.5623, 0.000051);
  // A regression with its residual gives back mean and deviation of what it predicts.
  const auto width = population::moments_of(women, {hand::DimensionKind::kHandWidth});
  ASSERT_TRUE(width);
  EXPECT_NEAR(width->mean, 78.15, 0.0051);
  EXPECT_NEAR(width->sd, 3.843, 0.005);
  // The survey's palm reaches further than ours: its mean is the template's 97.2 of 176.1 mm, its
  // coefficient of variation the survey's (Gordon et al. 2014: 108.9, SD 5.8 mm of 181.1 mm).
  const auto palm =
      population::moments_of(women, {hand::DimensionKind::kSegmentLength, hand::Segment::kPalm});
  ASSERT_TRUE(palm);
  EXPECT_NEAR(palm->mean, 181.08 * 97.2 / 176.1, 0.01);
  const population::ColumnDescription measured =
      population::describe(population::where(*ansur2(), "sex=F"), {"palm_length"})[0];
  EXPECT_NEAR(palm->sd / palm->mean, measured.summary->sd / measured.summary->mean, 2e-5);
  EXPECT_THAT(population.cautions, Contains(HasSubstr("palm_length is measured as 60.")));
  const formats::TestFolder folder;
  const std::string path = (folder / "survey.toml").string();
  write_population(path, population);
  const population::Population back = read_population(path);
  EXPECT_EQ(population_toml(back), population_toml(population));
}

TEST(TableStatistics, LeavesOutPairsThatAreNotComplete) {
  const population::DimensionTable table =
      parsed_table("hand_length_mm,hand_width_mm\n180,80\n190,NA\n185,84\n,90\n200,92\n195,86\n");
  const population::TableCorrelation c = population::correlate(table);
  EXPECT_EQ(c.pairs[0].pearson.n, 4);
  const auto r = population::regress(table, {"hand_length"});
  EXPECT_EQ(r[0].fit.n, 4);
  EXPECT_EQ(population::describe(table)[0].missing, 1);
}

TEST(TableStatistics, FewSubjectsAreDescribedButNotCorrelated) {
  const population::DimensionTable two =
      parsed_table("hand_length_mm,hand_width_mm\n180,80\n190,80\n");
  EXPECT_DOUBLE_EQ(population::describe(two)[0].summary->mean, 185.0);
  EXPECT_EQ(population::describe(parsed_table("hand_length_mm\n180\n"))[0].summary->n, 1);
  EXPECT_THAT(formats::message_of<InputError>([&] { population::correlate(two); }),
              HasSubstr("at least 3 are needed"));
  EXPECT_THAT(formats::message_of<InputError>([&] { population::regress(two, {"hand_length"}); }),
              HasSubstr("at least 3 are needed"));
  EXPECT_THAT(formats::message_of<UsageError>([&] {
                population::regress(two, {"hand_length", "handlength"});
              }),
              HasSubstr("named twice"));
}

TEST(TableStatistics, ColumnsThatDetermineNothingAreNamed) {
  const auto fault = [](const std::string& text, const std::vector<std::string>& on) {
    return formats::message_of<InputError>([&] { population::regress(parsed_table(text), on); });
  };
  const std::string constant = "hand_length_mm,hand_width_mm\n180,85\n190,85\n185,85\n200,85\n";
  EXPECT_THAT(
      formats::message_of<InputError>([&] { population::correlate(parsed_table(constant)); }),
      HasSubstr("t.csv:2: column 2 (hand_width_mm): all 4 values are 85 mm"));
  EXPECT_THAT(fault(constant, {"hand_width"}), HasSubstr("column 2 (hand_width_mm): all 4"));
  const std::string dependent =
      "hand_length_mm,span_mm,hand_width_mm\n180,360,85\n190,380,84\n185,370,88\n200,400,90\n";
  EXPECT_THAT(fault(dependent, {"hand_length", "span"}),
              AllOf(HasSubstr("t.csv:1: column 2 (span_mm): the covariance is singular"),
                    HasSubstr("columns 1 (hand_length_mm), 2 (span_mm)")));
  EXPECT_THAT(population::correlate(parsed_table(dependent)).notes,
              ElementsAre(HasSubstr("(span_mm) are linear")));
  EXPECT_THAT(
      population::correlate(parsed_table("hand_length_mm,a,b\n180,3,85\n190,1,84\n185,4,88\n"))
          .notes,
      ElementsAre(HasSubstr("3 subjects for 3 columns")));
  EXPECT_THAT(
      fault("hand_length_mm,hand_width_mm\n180,85\n190,\n185,NA\n200,90\n", {"hand_length"}),
      HasSubstr("column 2 (hand_width_mm): 2 subjects have it; at least 3"));
  EXPECT_THAT(formats::message_of<UsageError>(
                  [&] { population::usual_predictors(parsed_table("a_mm\n1\n2\n3\n")); }),
              HasSubstr("setting \"predictors\""));
  EXPECT_THAT(formats::message_of<UsageError>(
                  [&] { population::correlate(parsed_table("a_mm\n1\n2\n4\n")); }),
              HasSubstr("at least 2 are needed"));
  EXPECT_THAT(formats::message_of<UsageError>([&] {
                population::describe(parsed_table("a_mm,sex\n1,F\n2,F\n3,M\n"), {"sex"});
              }),
              HasSubstr("holds text"));
}

TEST(TablePopulation, SmallAndMixedGroupsCarryCautions) {
  std::vector<std::string> notes;
  const population::DimensionTable table = parsed_table(
      "sex,age,hand_length_mm,hand_circumference_mm,hand_width_mm\n"
      "F,20,170,180,76\nM,30,190,210,88\nF,40,175,183,77\nM,50,199,222,90\nF,30,181,190,82\n");
  const population::Population population =
      population::population_of_table(population::grouped(table, "", notes),
                                      {"hand_length", "hand_circumference"}, "five", "Five people");
  ASSERT_THAT(population.strata, SizeIs(1));
  EXPECT_FALSE(population.strata[0].sex);
  EXPECT_NEAR(*population.strata[0].age, 34.0, 1e-12);
  EXPECT_THAT(population.cautions,
              ElementsAre(HasSubstr("only 5 subjects"), HasSubstr("men and women in one"),
                          HasSubstr("grip strength isn't known")));
  EXPECT_THAT(formats::message_of<UsageError>([&] {
                population::population_of_table(population::grouped(table, "", notes), {"age"}, "x",
                                                "x");
              }),
              HasSubstr("none that Palmar knows"));
}

}  // namespace
}  // namespace palmar::records
