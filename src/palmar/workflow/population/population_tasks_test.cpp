// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/records/population/population_file.h"
#include "palmar/workflow/hand/workflow_test_hand.h"
#include "palmar/workflow/population/population_sample.h"
#include "palmar/workflow/population/table_correlate.h"
#include "palmar/workflow/population/table_describe.h"
#include "palmar/workflow/population/table_regress.h"

namespace palmar::workflow {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using workflow_test::TemporaryFolder;

/// Three women and four men.
constexpr const char* kPeople =
    "sex,hand_length_mm,hand_width_mm,shoe\n"
    "F,170,74,37\nF,180,77,40\nF,175,76.5,38\n"
    "M,190,84,43\nM,200,87,45\nM,195,86.5,44\nM,185,82,42\n";

/// First of the four data sets of Anscombe 1973, The American Statistician 27:17-21, which gives
/// the mean of y as 7.5, the line y = 3 + 0.5 x and R2 = 0.667 for it.
constexpr const char* kAnscombe =
    "x,y\n10,8.04\n8,6.95\n13,7.58\n9,8.81\n11,8.33\n14,9.96\n6,7.24\n4,4.26\n12,10.84\n"
    "7,4.82\n5,5.68\n";

class PopulationTasks : public testing::Test {
 protected:
  TableChoice table(const std::string& text) {
    const fs::path path = folder / "people.csv";
    formats::write_file(path, text);
    return {.file = path.string()};
  }
  std::string path(const std::string& name) const { return (folder / name).string(); }

  TemporaryFolder folder;
};

template <typename Task>
std::string usage_error_of(const Task& task) {
  try {
    task();
  } catch (const UsageError& error) {
    return error.what();
  }
  return "accepted";
}

TEST_F(PopulationTasks, GroupsOfATableMakeUpTheWhole) {
  TableDescribeRequest request{.table = table(kPeople)};
  const records::Descriptions whole = describe_table(request);
  request.table.by = "sex";
  request.out = path("tables");
  const records::Descriptions groups = describe_table(request);
  ASSERT_EQ(groups.groups.size(), 2U);
  const statistics::Summary& women = groups.groups[0].result[0].summary.value();
  const statistics::Summary& men = groups.groups[1].result[0].summary.value();
  EXPECT_EQ(women.mean, 175.0);  // mm
  EXPECT_EQ(women.sd, 5.0);      // mm
  EXPECT_EQ(men.mean, 192.5);    // mm
  EXPECT_NEAR(whole.groups[0].result[0].summary->mean, (3 * women.mean + 4 * men.mean) / 7, 1e-12);
  EXPECT_TRUE(fs::exists(folder / "tables" / "description.csv"));
}

TEST_F(PopulationTasks, ConditionsAndColumnsChooseFromTheTable) {
  TableDescribeRequest request{.table = table(kPeople)};
  request.table.conditions = {"sex=M", "hand_length>=190"};
  request.table.columns = {"hand_width"};
  const records::Descriptions tall = describe_table(request);
  EXPECT_EQ(tall.groups[0].subjects, 3);
  ASSERT_EQ(tall.groups[0].result.size(), 1U);
  EXPECT_NEAR(tall.groups[0].result[0].summary->mean, (84.0 + 87.0 + 86.5) / 3, 1e-12);  // mm
  request.table = table("sex\nF\nM\n");
  EXPECT_THROW(describe_table(request), Error);
}

TEST_F(PopulationTasks, CorrelationIsThatOfAnscombe) {
  const records::Correlations found =
      correlate_table({.table = table(kAnscombe), .out = path("figures"), .note = {}});
  ASSERT_EQ(found.groups[0].result.pairs.size(), 1U);
  EXPECT_NEAR(std::pow(found.groups[0].result.pairs[0].pearson.r, 2), 0.667, 5e-4);  // its digits
  for (const char* name : {"correlation.csv", "correlation.svg", "correlation.png"}) {
    EXPECT_TRUE(fs::exists(folder / "figures" / name)) << name;
  }
}

TEST_F(PopulationTasks, RegressionIsThatOfAnscombe) {
  TableRegressRequest request{.table = table(kAnscombe), .predictors = {"x"}};
  request.out = path("figures");
  const TableRegressOutcome outcome = regress_table(request);
  ASSERT_EQ(outcome.regressions.groups[0].result.size(), 1U);
  const statistics::LinearFit& fit = outcome.regressions.groups[0].result[0].fit;
  EXPECT_NEAR(fit.intercept.estimate, 3.0, 5e-3);
  EXPECT_NEAR(fit.slopes[0].estimate, 0.5, 5e-4);
  EXPECT_NEAR(fit.r2, 0.667, 5e-4);
  EXPECT_FALSE(outcome.population);
  EXPECT_TRUE(fs::exists(folder / "figures" / "y_on_x.svg"));
}

TEST_F(PopulationTasks, PopulationOfATableHasItsMeansAndShares) {
  std::string notes;
  TableRegressRequest request{.table = table(kPeople), .predictors = {"hand_length"}};
  request.table.by = "sex";
  request.population_out = path("our people.toml");
  request.note = [&](const std::string& text) { notes += text + "\n"; };
  regress_table(request);
  const population::Population people = records::load_population(request.population_out);
  EXPECT_EQ(people.name, "our_people");
  ASSERT_EQ(people.strata.size(), 2U);
  EXPECT_NEAR(people.strata[0].share, 3.0 / 7.0, 1e-12);
  EXPECT_EQ(people.strata[0].driving.at(0).mean, 175.0);  // mm
  EXPECT_EQ(people.strata[1].driving.at(0).mean, 192.5);  // mm
  EXPECT_THAT(notes, HasSubstr("only 3 subjects"));
  EXPECT_THAT(notes, HasSubstr("our people.toml is without shoe"));
}

TEST_F(PopulationTasks, WhatCannotBeAnalysedIsNamed) {
  const TableChoice people = table(kPeople);
  EXPECT_THAT(usage_error_of([&] { correlate_table({.table = people, .level = 95.0}); }),
              HasSubstr("confidence level 95"));
  TableRegressRequest alone{.table = people, .predictors = {"hand_length"}};
  alone.table.columns = {"hand_length"};
  EXPECT_THAT(usage_error_of([&] { regress_table(alone); }),
              HasSubstr("people.csv has no column beside the predictors"));
  TableCorrelateRequest flat{.table = table("sex,hand_length_mm,hand_width_mm\nF,170,80\n"
                                            "F,180,80\nF,175,80\nM,190,84\nM,200,87\nM,195,86\n")};
  flat.table.by = "sex";
  try {
    correlate_table(flat);
    FAIL() << "a width that is always the same was correlated";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("(sex F)"));
  }
}

TEST_F(PopulationTasks, MiddleManHasTheMeanHandOfTheSurvey) {
  // ANSUR II (Gordon et al. 2014): mean hand length of men 193.28 mm.
  PopulationSampleRequest request{.population = "ansur2_men"};
  request.sampling.design = population::SamplingDesign::kPercentiles;
  request.sampling.percentiles = {50.0};
  request.out = path("hands.csv");
  const PopulationSampleOutcome outcome = sample_population(request);
  ASSERT_EQ(outcome.hands.size(), 1U);
  const hand::SizedDimension& first = outcome.hands[0].dimensions.at(0);
  EXPECT_EQ(name_of(first.dimension), "hand_length");
  EXPECT_NEAR(first.value, 193.28, 0.005);  // mm; digits of the survey
  // The file is a table of subjects.
  const records::Descriptions read = describe_table({.table = {.file = request.out}});
  EXPECT_EQ(read.groups[0].subjects, 1);
}

TEST_F(PopulationTasks, FileOfASampleNeedsAKnownEnding) {
  PopulationSampleRequest request{.population = "ansur2_men", .out = "hands.txt"};
  EXPECT_EQ(usage_error_of([&] { request.check(); }),
            "setting \"out\" hands.txt: a name ending in .csv or .json is required");
  request.out.clear();
  request.sampling.hands = 0;
  EXPECT_THAT(usage_error_of([&] { sample_population(request); }),
              HasSubstr("number of hands is 0"));
}

}  // namespace
}  // namespace palmar::workflow
