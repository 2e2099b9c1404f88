// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "run_program.h"

// Grips, fingertip points and buttons as a user asks for them.

namespace palmar::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Json = nlohmann::json;

/// A 20 mm bar along z, made once.
const std::string& folder() {
  static const std::string made = [] {
    std::string name = temporary_folder();
    run_palmar("product make cylinder --diameter-mm 20 --length-mm 100 --out bar.stl", name);
    return name;
  }();
  return made;
}

ProgramRun grasp(const std::string& verb, const std::string& arguments) {
  return run_palmar("grasp " + verb + " bar.stl --unit mm " + arguments, folder());
}

TEST(GripCommand, ClosesByOtherNamesOfAGrip) {
  for (const std::string name : {"tripod", "chuck", "Tripod"}) {
    const ProgramRun run = grasp("close", "--json --grip " + name);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const Json json = Json::parse(run.out);
    EXPECT_EQ(json.at("grip"), "tripod");
    EXPECT_EQ(json.at("status"), "held");
    EXPECT_EQ(json.at("fingertips").size(), 3U);
    EXPECT_NEAR(json.at("grip_girth_mm").get<double>(), 62.8, 15.0);  // of a slanting section
  }
}

TEST(GripCommand, UnknownGripIsReportedWithTheNearest) {
  const ProgramRun run = grasp("close", "--grip tripot");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, AllOf(HasSubstr("\"tripot\""), HasSubstr("did you mean tripod?"),
                             HasSubstr("precision_sphere")));
}

TEST(GripCommand, FingertipsGoWhereTheyAreSent) {
  const std::string points = "--fingertip thumb:0,-10,0 --fingertip index:0,10,3";
  const ProgramRun run = grasp("close", "--json --grip pinch " + points);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const Json& tip : Json::parse(run.out).at("fingertips")) {
    EXPECT_LT(tip.at("miss_mm").get<double>(), 1.0);
  }
  const ProgramRun power = grasp("close", points);
  EXPECT_EQ(power.exit_code, 2);
  EXPECT_THAT(power.err, HasSubstr("a precision grip is required"));
  const ProgramRun off =
      grasp("close", "--grip pinch --fingertip thumb:0,-10,0 --fingertip index:0,19,3");
  EXPECT_EQ(off.exit_code, 2);
  EXPECT_THAT(off.err, HasSubstr("index finger (0, 19, 3 mm) is 9.0 mm off the surface"));
  const ProgramRun words = grasp("close", "--grip pinch --fingertip toe:0,0,0");
  EXPECT_EQ(words.exit_code, 2);
  EXPECT_THAT(words.err, HasSubstr("FINGER:X,Y,Z"));
}

TEST(GripCommand, PlacementsAreListedBestFirst) {
  const ProgramRun run = grasp("place", "--json --grip lateral --out list.json");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json json = Json::parse(run.out);
  ASSERT_GE(json.at("placements").size(), 2U);
  EXPECT_GT(json.at("candidates").get<int>(), 200);
  double last = 1.0;
  for (const Json& one : json.at("placements")) {
    EXPECT_LE(one.at("score").get<double>(), last + 1e-6);  // ties by rounding
    last = one.at("score").get<double>();
    EXPECT_TRUE(one.contains("posture"));
    EXPECT_TRUE(one.contains("product_from_hand"));
  }
  EXPECT_EQ(read_text(folder() + "/list.json"), run.out);
  EXPECT_EQ(grasp("place", "--json --grip lateral --threads 1").out, run.out);  // same bytes
}

TEST(ReachCommand, ReportsWhoReachesAButtonAndWritesTheMap) {
  ASSERT_EQ(grasp("close", "--grip tripod --out held.json").exit_code, 0);
  const Json held = Json::parse(read_text(folder() + "/held.json"));
  const Json& at = held.at("fingertips").at(1).at("target_mm");
  const std::string button = "index:" + at[0].dump() + "," + at[1].dump() + "," + at[2].dump();
  const ProgramRun run = grasp("reach",
                               "--json --grasp held.json --map map.vtp --map-points 40 "
                               "--button " +
                                   button);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json json = Json::parse(run.out);
  const Json& reach = json.at("buttons").at(0);
  EXPECT_EQ(reach.at("best"), "index");
  EXPECT_EQ(reach.at("fingers").size(), 5U);
  EXPECT_TRUE(reach.at("fingers").at(1).at("reached"));
  EXPECT_GT(json.at("map").at("reached_area_mm2").get<double>(), 0.0);
  EXPECT_THAT(read_text(folder() + "/map.vtp"),
              AllOf(HasSubstr("margin_deg"), HasSubstr("finger")));
}

TEST(ReachCommand, SaysWhatIsWrongWithAButton) {
  const ProgramRun none = grasp("reach", "");
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.err, HasSubstr("--button NAME:X,Y,Z or --map"));
  const ProgramRun words = grasp("reach", "--button 1,2,3");
  EXPECT_EQ(words.exit_code, 2);
  EXPECT_THAT(words.err, HasSubstr("NAME:X,Y,Z"));
  const ProgramRun off = grasp("reach", "--grip tripod --button on:0,30,0");
  EXPECT_EQ(off.exit_code, 2);
  EXPECT_THAT(off.err, HasSubstr("button \"on\" (0, 30, 0 mm) is 20.0 mm off the surface"));
}

}  // namespace
}  // namespace palmar::testing
