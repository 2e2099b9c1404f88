// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/population/population_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/test_files.h"
#include "palmar/population/built_in_populations.h"
#include "palmar/population/hand_sample.h"
#include "palmar/records/population/hand_sample_table.h"

namespace palmar::records {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

// As in docs/using/populations.md.
constexpr const char* kWomen = R"(name = "our_women"
title = "Women of our plant"
source = "40 women, measured 2024"
cautions = ["one plant only"]

[[stratum]]
name = "women"
sex = "female"
age_years = 35

[[stratum.driving]]
dimension = "hand_length"
mean_mm = 175.0
sd_mm = 9.0

[[stratum.driving]]
dimension = "hand_circumference"
mean_mm = 182.0
sd_mm = 8.0
evidence = "scaled"
source = "elsewhere"

[[stratum.correlation]]
between = ["hand_length", "hand_circumference"]
r = 0.55

[[stratum.regression]]
dimension = "index_middle_length"
intercept_mm = 1.5
slope = { hand_length = 0.12 }
residual_sd_mm = 0.8
)";

// Message for the text with `from` replaced by `to`.
std::string message_with(const std::string& from, const std::string& to) {
  std::string text = kWomen;
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
  return formats::message_of<InputError>([&] { parse_population(text, "women.toml"); });
}

TEST(PopulationFile, ReadsWhatItSays) {
  const population::Population women = parse_population(kWomen, "women.toml");
  EXPECT_EQ(women.name, "our_women");
  EXPECT_EQ(women.cautions, std::vector<std::string>{"one plant only"});
  ASSERT_EQ(women.strata.size(), 1U);
  const population::Stratum& stratum = women.strata.front();
  EXPECT_EQ(stratum.sex, grasp::Sex::kFemale);
  EXPECT_EQ(stratum.age, 35.0);
  EXPECT_EQ(stratum.share, 1.0);
  ASSERT_EQ(stratum.driving.size(), 2U);
  EXPECT_EQ(stratum.driving[0].evidence, population::Evidence::kMeasured);
  EXPECT_EQ(stratum.driving[1].evidence, population::Evidence::kScaled);
  EXPECT_EQ(stratum.driving[1].sd, 8.0);
  EXPECT_EQ(stratum.correlation(0, 1), 0.55);
  ASSERT_EQ(stratum.regressions.size(), 1U);
  EXPECT_EQ(stratum.regressions[0].terms[0].slope, 0.12);
  EXPECT_EQ(stratum.regressions[0].evidence, population::Evidence::kRegressed);
}

// Every number survives to the last bit: the hands that are drawn are the same.
TEST(PopulationFile, WrittenPopulationsGiveTheSameHands) {
  const formats::TestFolder folder;
  const std::string path = (folder / "population.toml").string();
  for (const population::Population& population : population::built_in_populations()) {
    write_population(path, population);
    const population::Population back = load_population(path);
    EXPECT_EQ(back.source, population.source);
    EXPECT_EQ(back.cautions, population.cautions);
    const auto before = population::sample_hands(population, {}),
               after = population::sample_hands(back, {});
    ASSERT_EQ(before.size(), after.size());
    for (std::size_t k = 0; k < before.size(); ++k) {
      EXPECT_EQ(before[k].grip_strength, after[k].grip_strength);
      for (std::size_t d = 0; d < before[k].dimensions.size(); ++d) {
        // Slopes come back in alphabetical order: the sum over them may round otherwise.
        EXPECT_NEAR(before[k].dimensions[d].value, after[k].dimensions[d].value, 1e-12);
      }
    }
  }
}

TEST(PopulationFile, MessagesNameLineValueAndWhatIsAllowed) {
  EXPECT_THAT(message_with("mean_mm = 175.0", "mean_cm = 17.5"),
              AllOf(HasSubstr("women.toml:13"), HasSubstr("did you mean mean_mm?")));
  EXPECT_THAT(message_with("mean_mm = 175.0", "mean_mm = 17.5"),
              AllOf(HasSubstr("women.toml:13"), HasSubstr("mean_mm of hand_length is 17.5 mm"),
                    HasSubstr("60 to 300 mm"), HasSubstr("look like cm")));
  EXPECT_THAT(message_with("mean_mm = 182.0", "mean_mm = 18.2"),
              AllOf(HasSubstr("mean_mm of hand_circumference is 18.2 mm"), HasSubstr("like cm")));
  EXPECT_THAT(message_with("{ hand_length = 0.12 }", "{ hand_length = 1.2 }"),
              AllOf(HasSubstr("women.toml:27"), HasSubstr("index_middle_length is 211.5 mm"),
                    HasSubstr("8.48 to 53 mm")));
  EXPECT_THAT(message_with("mean_mm = 175.0", "mean_mm = \"long\""),
              AllOf(HasSubstr("women.toml:13"), HasSubstr("mean_mm is no number; 1 to 400 mm")));
  EXPECT_THAT(message_with("sd_mm = 9.0", "sd_mm = 0.0"),
              AllOf(HasSubstr("women.toml:14"), HasSubstr("sd_mm is 0 mm; 1e-06 to 35 mm")));
  EXPECT_THAT(message_with("sd_mm = 9.0", "sd_mm = -9.0"), HasSubstr("sd_mm is -9 mm"));
  EXPECT_THAT(message_with("\"hand_length\"\nmean", "\"hand_lenght\"\nmean"),
              AllOf(HasSubstr("women.toml:12"), HasSubstr("did you mean hand_length?")));
  EXPECT_THAT(message_with("r = 0.55", "r = 1.0"),
              AllOf(HasSubstr("women.toml:25"), HasSubstr("r is 1; between -1 and 1")));
  EXPECT_THAT(message_with("r = 0.55", "r = 1.5"), HasSubstr("r is 1.5; -1 to 1 is allowed"));
  EXPECT_THAT(message_with("{ hand_length = 0.12 }", "{ hand_width = 0.12 }"),
              AllOf(HasSubstr("women.toml:27"), HasSubstr("hand_width neither drives")));
  EXPECT_THAT(message_with("age_years = 35", "share = 0.5"),
              HasSubstr("shares of the strata add up to 0.5; 1 is required"));
  EXPECT_THAT(message_with("sex = \"female\"", "sex = \"woman\""),
              AllOf(HasSubstr("women.toml:8"), HasSubstr("\"female\" or \"male\" is allowed")));
  EXPECT_THAT(message_with("\"scaled\"", "\"guessed\""), HasSubstr("\"regressed\" or \"scaled\""));
  EXPECT_THAT(message_with("name = \"our_women\"", "version = 2\nname = \"x\""),
              HasSubstr("this program reads up to version 1"));
  EXPECT_THAT(message_with("[[stratum.correlation]]\nbetween = [\"hand_length\", "
                           "\"hand_circumference\"]\nr = 0.55",
                           ""),
              HasSubstr("correlation of hand_length and hand_circumference is missing"));
  EXPECT_THAT(message_with("r = 0.55", "r = "), HasSubstr("women.toml:25: no TOML"));
}

TEST(PopulationFile, CorrelationsThatContradictEachOtherAreNamed) {
  const std::string text = R"(name = "three"
[[stratum]]
name = "people"
driving = [
  { dimension = "hand_length", mean_mm = 184, sd_mm = 10 },
  { dimension = "hand_circumference", mean_mm = 193, sd_mm = 14 },
  { dimension = "hand_width", mean_mm = 80, sd_mm = 4 },
]
correlation = [
  { between = ["hand_length", "hand_circumference"], r = 0.9 },
  { between = ["hand_length", "hand_width"], r = 0.9 },
  { between = ["hand_circumference", "hand_width"], r = -0.9 },
]
)";
  EXPECT_THAT(formats::message_of<InputError>([&] { parse_population(text, "three.toml"); }),
              AllOf(HasSubstr("three.toml:2"), HasSubstr("stratum \"people\""),
                    HasSubstr("positive definite")));
}

TEST(PopulationFile, NamesOrFiles) {
  EXPECT_EQ(load_population("xie2014").name, "xie2014");
  EXPECT_THAT(formats::message_of<UsageError>([] { load_population("xie2015"); }),
              HasSubstr("did you mean xie2014?"));
  EXPECT_THAT(formats::message_of<InputError>([] { load_population("not_there.toml"); }),
              HasSubstr("not_there.toml"));
}

TEST(HandSampleTable, OneRowPerHandWithUnitsInTheHeader) {
  population::SamplingOptions options;
  options.design = population::SamplingDesign::kPercentiles;
  const CsvTable table =
      hand_sample_table(population::sample_hands(population::population_named("xie2014"), options));
  EXPECT_EQ(table.header,
            (std::vector<std::string>{"subject", "stratum", "sex", "age_years", "grip_strength_n",
                                      "hand_length_mm", "hand_circumference_mm"}));
  ASSERT_EQ(table.rows.size(), 3U);
  EXPECT_EQ(table.rows[1],
            (std::vector<std::string>{"P50 adults", "adults", "", "", "", "184.000", "193.000"}));
}

}  // namespace
}  // namespace palmar::records
