// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "run_program.h"

// `palmar population describe|correlate|regress` as a whole.

namespace palmar::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using Json = nlohmann::json;

// Seven people as an office program writes them: semicolons, decimal commas, two units, gaps.
constexpr const char* kTable =
    "id;sex;Age [years];Hand length [mm];handbreadth (cm);Hand circumference "
    "[mm];grip_strength_n\r\n"
    "a;F;23;181,5;8,1;190;310\r\nb;M;31;193,0;8,9;212;480\r\nc;F;44;176;7,6;182;\r\n"
    "d;M;29;201;9,2;221;520\r\ne;M;52;188;8,7;NA;450\r\nf;F;38;169;7,4;178;270\r\n"
    "g;;61;184;8,2;195;300\r\n";

class PopulationTable : public ::testing::Test {
 protected:
  PopulationTable() { write_text(folder + "/hands.csv", kTable); }
  ProgramRun run(const std::string& arguments) {
    return run_palmar("population " + arguments, folder);
  }
  Json json_of(const std::string& arguments) {
    const ProgramRun result = run(arguments + " --json");
    EXPECT_EQ(result.exit_code, 0) << arguments << "\n" << result.err;
    return result.exit_code == 0 ? Json::parse(result.out) : Json();
  }
  std::string folder = temporary_folder();
};

TEST_F(PopulationTable, DescribesGroups) {
  const Json json = json_of("describe hands.csv --by sex");
  ASSERT_EQ(json.at("groups").size(), 2U);
  const Json& women = json.at("groups")[0];
  EXPECT_EQ(women.at("group"), "F");
  EXPECT_EQ(women.at("subjects"), 3);
  const Json& length = women.at("dimensions")[0];
  EXPECT_EQ(length.at("name"), "hand_length");
  EXPECT_NEAR(length.at("mean_mm").get<double>(), (181.5 + 176 + 169) / 3, 1e-9);
  EXPECT_EQ(women.at("dimensions")[3].at("missing"), 1);
  EXPECT_NEAR(women.at("dimensions")[1].at("mean_mm").get<double>(), 77.0, 1e-9);  // cm in the file
  EXPECT_THAT(json.at("notes").dump(),
              AllOf(HasSubstr("from cm into mm"), HasSubstr("1 of 7 subjects have no sex")));
  const ProgramRun text = run("describe hands.csv --where sex=M --dimension hand_length");
  EXPECT_THAT(text.out, AllOf(HasSubstr("3 subjects"), HasSubstr("194.00")));
}

TEST_F(PopulationTable, CorrelatesAndDraws) {
  const Json json = json_of("correlate hands.csv --out figures");
  const Json& pair = json.at("groups")[0].at("pairs")[0];
  EXPECT_EQ(pair.at("n"), 7);
  EXPECT_GT(pair.at("r").get<double>(), 0.9);
  EXPECT_LT(pair.at("p_value").get<double>(), pair.at("p_holm").get<double>());
  EXPECT_THAT(read_text(folder + "/figures/correlation.svg"), StartsWith("<svg"));
  EXPECT_THAT(read_text(folder + "/figures/correlation.png"), StartsWith("\x89PNG"));
  EXPECT_THAT(read_text(folder + "/figures/correlation.pdf"), StartsWith("%PDF"));
  EXPECT_THAT(read_text(folder + "/figures/correlation.csv"),
              StartsWith("group,a,b,n,r,r_low,r_high,p_value"));
}

TEST_F(PopulationTable, RegressesAndWritesAPopulationThatCanBeSampled) {
  const ProgramRun first = run("regress hands.csv --out a --population-out a.toml");
  EXPECT_EQ(first.exit_code, 0) << first.err;
  EXPECT_THAT(first.err, AllOf(HasSubstr("only 6 subjects"), HasSubstr("men and women in one"),
                               HasSubstr("grip strength isn't known"),
                               HasSubstr("a.toml is without grip_strength_n")));
  EXPECT_THAT(first.out, HasSubstr("the better predictor"));
  EXPECT_THAT(read_text(folder + "/a/hand_width_on_hand_length.svg"), HasSubstr("<polygon"));
  // The same bytes again.
  run("regress hands.csv --out b --population-out b/a.toml");
  for (const char* name :
       {"/hand_width_on_hand_length.png", "/hand_width_on_hand_length.pdf", "/regression.csv"}) {
    EXPECT_EQ(read_text(folder + "/a" + name), read_text(folder + "/b" + name)) << name;
  }
  EXPECT_EQ(read_text(folder + "/a.toml"), read_text(folder + "/b/a.toml"));
  const ProgramRun sample = run("sample a.toml --hands 5");
  EXPECT_EQ(sample.exit_code, 0) << sample.err;
  EXPECT_THAT(sample.out, HasSubstr("hand_width_mm"));
}

TEST_F(PopulationTable, BadTablesAndOptionsEndWithTheirExitCodes) {
  write_text(folder + "/cm.csv", "hand_length_mm\n18.1\n19.3\n17.6\n");
  ProgramRun result = run("describe cm.csv");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err,
              AllOf(HasSubstr("cm.csv:1: column 1 (hand_length_mm)"), HasSubstr("in cm")));
  write_text(folder + "/flat.csv", "hand_length_mm,hand_width_mm\n181,80\n193,80\n176,80\n");
  result = run("correlate flat.csv");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err,
              HasSubstr("flat.csv:2: column 2 (hand_width_mm): all 3 values are 80 mm"));
  EXPECT_EQ(run("describe none.csv").exit_code, 3);
  EXPECT_EQ(run("describe hands.csv --by colour").exit_code, 2);
  EXPECT_EQ(run("describe hands.csv --where sex").exit_code, 2);
  EXPECT_EQ(run("correlate hands.csv --confidence 95").exit_code, 2);
  EXPECT_EQ(run("regress hands.csv --confidence 1.5").exit_code, 2);
  EXPECT_EQ(run("regress hands.csv --on hand_length,hand_length").exit_code, 2);
  EXPECT_THAT(run("--help").out, HasSubstr("Example: palmar population sample"));
  EXPECT_EQ(run("regress hands.csv --on sex").exit_code, 2);
  EXPECT_THAT(run("regress hands.csv --on hand_lenght").err,
              HasSubstr("did you mean hand_length?"));
  EXPECT_THAT(run("regress -h").out, HasSubstr("palmar population regress hands.csv --by sex"));
}

}  // namespace
}  // namespace palmar::testing
