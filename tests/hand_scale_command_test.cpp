// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "run_program.h"

// `palmar hand scale` as a user runs it.

namespace palmar::testing {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

TEST(HandScaleCommand, WritesAHandOfTheDimensionsAsked) {
  const std::string folder = temporary_folder();
  const ProgramRun run = run_palmar(
      "hand scale --hand-length-mm 193 --circumference-mm 212 --dimension index_middle_width=18 "
      "--out man.hand.glb --json",
      folder);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json reported = Json::parse(run.out);
  EXPECT_EQ(reported.at("driven").size(), 3U);
  EXPECT_EQ(reported.at("driven").at(2).at("dimension"), "index_middle_width");
  EXPECT_NEAR(reported.at("driven").at(2).at("measured_mm").get<double>(), 18.0, 0.1);
  EXPECT_LE(reported.at("largest_miss_mm").get<double>(), 0.1);
  EXPECT_EQ(reported.at("measured").size(), 47U);
  const Json info = Json::parse(run_palmar("hand info man.hand.glb --json", folder).out);
  EXPECT_NEAR(info.at("hand_length_mm").get<double>(), 193.0, 0.1);
  EXPECT_NEAR(info.at("hand_circumference_mm").get<double>(), 212.0, 0.1);
}

TEST(HandScaleCommand, ReportsAskedBesideMeasured) {
  const ProgramRun run = run_palmar("hand scale --hand-length-mm 180 --palm-length-mm 97");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("asked"));
  EXPECT_THAT(run.out, HasSubstr("palm_length                   97.00"));
}

TEST(HandScaleCommand, TakesARowOfATable) {
  const std::string folder = temporary_folder();
  write_text(folder + "/people.csv",
             "subject,hand_length_mm,hand_circumference_mm\n"
             "ann,170,180\nbob,195,\ncy,200,220\n");
  const ProgramRun ann = run_palmar("hand scale --table people.csv --row ann --json", folder);
  ASSERT_EQ(ann.exit_code, 0) << ann.err;
  EXPECT_NEAR(Json::parse(ann.out).at("measured").at("hand_circumference_mm").get<double>(), 180.0,
              0.1);
  const ProgramRun bob = run_palmar("hand scale --table people.csv --row bob --json", folder);
  ASSERT_EQ(bob.exit_code, 0) << bob.err;
  EXPECT_EQ(Json::parse(bob.out).at("driven").size(), 1U);  // a missing cell isn't driven
  const ProgramRun dan = run_palmar("hand scale --table people.csv --row dan", folder);
  EXPECT_EQ(dan.exit_code, 2);
  EXPECT_THAT(dan.err, HasSubstr("subject"));
}

TEST(HandScaleCommand, TakesARowByNumberWhereNoColumnNamesSubjects) {
  const std::string folder = temporary_folder();
  write_text(folder + "/people.csv",
             "sex,hand_length_mm,palm_length_mm\nM,195,117\nF,170,102\nM,190,114\n");
  const ProgramRun second = run_palmar("hand scale --table people.csv --row 2 --json", folder);
  ASSERT_EQ(second.exit_code, 0) << second.err;
  EXPECT_NEAR(Json::parse(second.out).at("measured").at("hand_length_mm").get<double>(), 170.0,
              0.1);
  EXPECT_THAT(second.err, HasSubstr("fingers too short"));  // 60 % of hand length
  const ProgramRun men = run_palmar("hand scale --table people.csv --row M", folder);
  EXPECT_EQ(men.exit_code, 2);
  EXPECT_THAT(men.err, HasSubstr("2 subjects of people.csv have it in their column \"sex\""));
  const ProgramRun fourth = run_palmar("hand scale --table people.csv --row 4", folder);
  EXPECT_EQ(fourth.exit_code, 2);
  EXPECT_THAT(fourth.err, HasSubstr("1 to 3, is allowed"));
  write_text(folder + "/one.csv", "name,hand_length_mm\nann,170\n");
  EXPECT_EQ(run_palmar("hand scale --table one.csv --row ann", folder).exit_code, 0);
}

TEST(HandScaleCommand, ScalesByOneFactor) {
  const std::string folder = temporary_folder();
  const ProgramRun run = run_palmar("hand scale --factor 0.5 --out child.hand.glb", folder);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json whole = Json::parse(run_palmar("hand info template --json").out);
  const Json half = Json::parse(run_palmar("hand info child.hand.glb --json", folder).out);
  EXPECT_NEAR(half.at("hand_length_mm").get<double>(),
              0.5 * whole.at("hand_length_mm").get<double>(), 0.01);
}

TEST(HandScaleCommand, RefusesWhatIsNotADimensionOrContradicts) {
  const ProgramRun name = run_palmar("hand scale --dimension index_proximal_lenght=20");
  EXPECT_EQ(name.exit_code, 2);
  EXPECT_THAT(name.err, HasSubstr("did you mean index_proximal_length?"));
  const ProgramRun nothing = run_palmar("hand scale --out x.hand.glb");
  EXPECT_EQ(nothing.exit_code, 2);
  EXPECT_THAT(nothing.err, HasSubstr("--hand-length-mm"));
  const ProgramRun large = run_palmar("hand scale --hand-length-mm 900");
  EXPECT_EQ(large.exit_code, 2);
  EXPECT_THAT(large.err, HasSubstr("hand_length is 900.0 mm"));
  const ProgramRun twice =
      run_palmar("hand scale --hand-length-mm 180 --dimension hand_length=170");
  EXPECT_EQ(twice.exit_code, 2);
  EXPECT_THAT(twice.err, HasSubstr("given twice"));
}

}  // namespace
}  // namespace palmar::testing
