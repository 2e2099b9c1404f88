// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "run_program.h"

// `palmar population list|show|sample` as a whole.

namespace palmar::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Json = nlohmann::json;

Json json_of(const std::string& arguments) {
  const ProgramRun run = run_palmar("population " + arguments + " --json");
  EXPECT_EQ(run.exit_code, 0) << arguments << "\n" << run.err;
  return run.exit_code == 0 ? Json::parse(run.out) : Json();
}

TEST(PopulationSampleCommand, ListsPopulationsAndProfiles) {
  const Json list = json_of("list");
  std::vector<std::string> names;
  for (const Json& one : list.at("populations")) names.push_back(one.at("name"));
  EXPECT_THAT(names, ::testing::IsSupersetOf({"xie2014", "ansur2_men", "ansur2_women", "ansur2",
                                              "japanese_men", "japanese_women", "japanese"}));
  EXPECT_EQ(list.at("profiles")[0].at("name"), "none");
  EXPECT_THAT(run_palmar("population list").out, HasSubstr("thick_gloves"));
}

TEST(PopulationSampleCommand, ShowReportsHowEveryDimensionIsKnown) {
  const ProgramRun run = run_palmar("population show ansur2_women");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.out, AllOf(HasSubstr("measured"), HasSubstr("regressed"), HasSubstr("scaled"),
                             HasSubstr("ANSUR II"), HasSubstr("cautions")));
  EXPECT_THAT(run_palmar("population show xie2014").out, HasSubstr("Mixes the sexes"));
  const Json women = json_of("show ansur2_women");
  const Json& length = women.at("strata")[0].at("dimensions")[0];
  EXPECT_EQ(length.at("dimension"), "hand_length");
  EXPECT_EQ(length.at("mean_mm"), 181.08);
  EXPECT_EQ(length.at("evidence"), "measured");
}

TEST(PopulationSampleCommand, TheSameSeedGivesTheSameBytesWhateverTheThreads) {
  const std::string draw = "population sample ansur2 --hands 20 ";
  const ProgramRun one = run_palmar(draw + "--seed 5 --threads 1");
  EXPECT_EQ(one.exit_code, 0) << one.err;
  EXPECT_EQ(one.out, run_palmar(draw + "--seed 5 --threads 4").out);
  EXPECT_NE(one.out, run_palmar(draw + "--seed 6").out);
  EXPECT_THAT(one.err, HasSubstr("two men to a woman"));  // the caution, not among the rows
  // A file that was written out gives the same people.
  const std::string folder = temporary_folder();
  ASSERT_EQ(run_palmar("population show ansur2 --out mine.toml", folder).exit_code, 0);
  const ProgramRun mine = run_palmar("population sample mine.toml --hands 20 --seed 5", folder);
  EXPECT_EQ(mine.out, one.out);
}

TEST(PopulationSampleCommand, TableHasOneRowPerHandWithUnits) {
  const std::string folder = temporary_folder();
  const ProgramRun run = run_palmar("population sample xie2014 --hands 7 --out hands.csv", folder);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  std::istringstream table(read_text(folder + "/hands.csv"));
  std::string line;
  std::getline(table, line);
  EXPECT_EQ(line,
            "subject,stratum,sex,age_years,grip_strength_n,hand_length_mm,hand_circumference_mm");
  int rows = 0;
  while (std::getline(table, line)) ++rows;
  EXPECT_EQ(rows, 7);
}

TEST(PopulationSampleCommand, DesignsDrawTheirHands) {
  const Json boundary = json_of("sample xie2014 --design boundary --points 8");
  EXPECT_EQ(boundary.at("hands").size(), 9U);
  const Json ends = json_of("sample ansur2 --design percentiles --percentiles 5,95");
  ASSERT_EQ(ends.at("hands").size(), 4U);
  EXPECT_EQ(ends.at("hands")[2].at("subject"), "P5 woman");
  EXPECT_NEAR(ends.at("hands")[1].at("dimensions").at("hand_length_mm").get<double>(),
              193.28 + 1.6448536 * 9.946, 1e-3);
  // Who asks for percentiles gets them, whether or not the design is said.
  EXPECT_EQ(json_of("sample ansur2 --percentiles 5,95"), ends);
  const ProgramRun other = run_palmar("population sample ansur2 --percentiles 5 --design random");
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, HasSubstr("--percentiles goes with --design percentiles"));
}

TEST(PopulationSampleCommand, BadInputIsNamed) {
  const ProgramRun name = run_palmar("population show ansur3");
  EXPECT_EQ(name.exit_code, 2);
  EXPECT_THAT(name.err, HasSubstr("did you mean ansur2?"));
  const ProgramRun file = run_palmar("population show nobody.toml");
  EXPECT_EQ(file.exit_code, 3);
  EXPECT_THAT(file.err, HasSubstr("nobody.toml"));
  const ProgramRun design = run_palmar("population sample xie2014 --design latin");
  EXPECT_EQ(design.exit_code, 2);
  EXPECT_THAT(design.err, HasSubstr("--design latin"));
  const ProgramRun hands = run_palmar("population sample xie2014 --hands 0");
  EXPECT_EQ(hands.exit_code, 2);
  EXPECT_THAT(hands.err, HasSubstr("number of hands is 0; 1 to 1000000"));
  EXPECT_THAT(run_palmar("population sample -h").out, HasSubstr("palmar population sample ansur2"));
}

}  // namespace
}  // namespace palmar::testing
