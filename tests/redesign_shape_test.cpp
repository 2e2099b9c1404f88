// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "run_program.h"

// Redesign 4 as a user runs it: handles shaped anew by named features.

namespace palmar::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Json = nlohmann::json;

const std::string kPrism =
    "\"made: prism width_mm=30 depth_mm=40 length_mm=130 fillet_mm=3\" --grip-force-n 60";
const std::string kFew = " --hands 2 --seed 2014 --no-compare --no-pictures --quiet";

const std::string& folder() {
  static const std::string made = temporary_folder();
  return made;
}

ProgramRun shape(const std::string& arguments) {
  return run_palmar("redesign shape " + arguments, folder());
}

TEST(RedesignShape, ASearchWritesASolidItsFeaturesAndItsHistory) {
  const ProgramRun run = shape(kPrism + " --evaluations 3 --json --out search" + kFew);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json json = Json::parse(run.out);
  EXPECT_EQ(json.at("search").at("history").size(), 3U);
  EXPECT_TRUE(json.at("is_whole").get<bool>());
  for (const char* file : {"redesign.step", "redesign.stl", "handle.toml", "handle.FCMacro",
                           "history.csv", "history.svg", "shape.json"}) {
    EXPECT_TRUE(fs::is_regular_file(fs::path(folder()) / "search" / file)) << file;
  }
  const ProgramRun check = run_palmar("product check search/redesign.step --json", folder());
  EXPECT_EQ(check.exit_code, 0) << check.out << check.err;
}

TEST(RedesignShape, GivenFeaturesAreMadeAsTheyAreAndTheFileMakesThemAgain) {
  const ProgramRun run = shape(kPrism + " --vary width=32 --vary depth=42 --vary squareness=0" +
                               " --vary turn=0 --vary taper=0 --json --out made" + kFew);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json json = Json::parse(run.out);
  const double length = 130.0, r = json.at("end_radius_mm").get<double>();
  // An elliptic bar; rounding both ends takes about perimeter x r^2 (2 - pi / 2) away.
  const double volume = M_PI * 16.0 * 21.0 * length - M_PI * 37.0 * r * r * (2.0 - M_PI / 2.0);
  EXPECT_NEAR(json.at("solid").at("volume_mm3").get<double>(), volume, 2e-3 * volume);
  EXPECT_LE(json.at("solid").at("poles").get<int>(), 600);
  const ProgramRun again = shape(kPrism + " --features made/handle.toml --json --out again" + kFew);
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(read_text(folder() + "/made/redesign.step"),
            read_text(folder() + "/again/redesign.step"));
}

TEST(RedesignShape, WhatCanNotBeIsRefusedWithItsName) {
  struct Case {
    std::string arguments, message;
    int exit_code = 2;
  };
  for (const Case& one : {
           Case{kPrism + " --vary widt", "did you mean width?"},
           Case{kPrism + " --vary width=40:30", "12 to 90 mm are allowed"},
           Case{kPrism + " --vary width=x", "\"x\" is no number"},
           Case{kPrism + " --both-hands --vary twist=3", "suits one hand only"},
           Case{kPrism + " --features nothing.toml", "nothing.toml", 3},
           Case{kPrism + " --keep-box 1,2,3", "two corners X0,Y0,Z0,X1,Y1,Z1"},
           Case{kPrism + " --spread-mm 99", "--spread-mm is 99; 0 to 30 mm is allowed"},
           Case{"\"made: prism\" --hold-posture kept", "--hold-posture kept"},
       }) {
    const ProgramRun run = shape(one.arguments + " --out none" + kFew);
    EXPECT_EQ(run.exit_code, one.exit_code) << one.arguments << run.err;
    EXPECT_THAT(run.err, HasSubstr(one.message)) << one.arguments;
  }
}

TEST(RedesignShape, AFileThatCanNotBeReadIsSaidBeforeAnyHandHoldsTheProduct) {
  write_text(folder() + "/bad.toml", "version = 1\n[features]\nwidth_mm = 300\ndepth_mm = 40\n");
  const ProgramRun run = shape(kPrism + " --features bad.toml --hands 2 --out none");
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_EQ(run.err.find("palmar: "), 0U) << run.err;
  EXPECT_THAT(run.err, HasSubstr("bad.toml"));
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
}

TEST(RedesignShape, StoppedInTheSearchItEndsWithItsCodeAndLeavesNothing) {
  const ProgramRun run = shape(kPrism + " --evaluations 60 --out stopped" + kFew +
                               " & sleep 6; kill -INT $!; wait $!");
  EXPECT_EQ(run.exit_code, 130) << run.err;
  EXPECT_FALSE(fs::exists(fs::path(folder()) / "stopped"));
}

TEST(RedesignShape, APlainHandleIsJudgedInOtherHandsAndWhereTheyLieElsewhere) {
  const ProgramRun run = run_palmar(
      "redesign shape " + kPrism +
          " --vary width=33 --vary depth=42 --vary squareness=0.2 --vary turn=0 --hands 6"
          " --seed 2014 --no-pictures --quiet --json --out judged",
      folder());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json json = Json::parse(run.out);
  EXPECT_TRUE(json.at("comparison").at("in_other_hands").get<bool>());
  EXPECT_FALSE(json.at("comparison").at("hold_changes").at(0).at("is_other_hold").get<bool>());
  const Json& offsets = json.at("gains").at("offsets");
  ASSERT_EQ(offsets.size(), 7U);
  EXPECT_EQ(offsets.at(0).at("offset_mm"), -12.0);
  EXPECT_EQ(offsets.at(6).at("offset_mm"), 12.0);
  // A rounded oval presses less than a brick with fillets of 3 mm, at equal force; wherever.
  for (const Json& one : offsets) {
    const Json& peak = one.at("changes").at("peak_pressure_cells_mpa");
    EXPECT_GT(peak.at("hands").get<int>(), 3);
    EXPECT_LT(peak.at("change_share").get<double>(), 0.0) << one;
    const Json& force = one.at("changes").at("grip_force_n");
    EXPECT_NEAR(force.at("change_share").get<double>(), 0.0, 0.01);
  }
  EXPECT_EQ(json.at("gains").at("sizes").size(), 3U);
  EXPECT_TRUE(fs::is_regular_file(fs::path(folder()) / "judged" / "gains.svg"));
  EXPECT_TRUE(fs::is_regular_file(fs::path(folder()) / "judged" / "report" / "report.html"));
}

}  // namespace
}  // namespace palmar::testing
