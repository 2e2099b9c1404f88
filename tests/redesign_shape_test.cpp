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
  // An elliptic bar; rounding both ends over 75 degrees takes about perimeter x r^2 x 0.37 away.
  const double volume = M_PI * 16.0 * 21.0 * length - M_PI * 37.0 * r * r * 0.373;
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
           Case{kPrism + " --use \"hand=up\"", "\"hand=up\" is not known"},
           Case{kPrism + " --use \"grip-force-n=0\"", "1 to 500 is allowed"},
           Case{kPrism + " --draft-deg 40 --pull 1,0,0", "--draft-deg is 40; 0 to 30 degrees"},
           Case{kPrism + " --pull 0,0,1", "90 degrees off the sections of the handle"},
           Case{kPrism + " --keep-face 99", "no face 99"},
           Case{kPrism + " --goal torqe", "did you mean torque?"},
       }) {
    const ProgramRun run = shape(one.arguments + " --out none" + kFew);
    EXPECT_EQ(run.exit_code, one.exit_code) << one.arguments << run.err;
    EXPECT_THAT(run.err, HasSubstr(one.message)) << one.arguments;
  }
}

TEST(RedesignShape, SeveralUsesAreSearchedDrawnAndJudgedEach) {
  const ProgramRun run = run_palmar(
      "redesign shape " + kPrism +
          " --use \"weight=3\" --use \"hand=left weight=1 grip-force-n=30\" --evaluations 3"
          " --hands 2 --seed 2014 --no-pictures --quiet --json --out uses",
      folder());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json json = Json::parse(run.out);
  const Json& search = json.at("search");
  ASSERT_EQ(search.at("uses").size(), 2U);
  EXPECT_NEAR(search.at("original").get<double>(), 1.0, 1e-9);
  int whole = 0;
  for (const Json& one : search.at("history")) {
    if (!one.contains("by_use")) continue;
    ++whole;
    const auto by_use = one.at("by_use").get<std::vector<double>>();
    EXPECT_NEAR(one.at("goal").get<double>(), 0.75 * by_use[0] + 0.25 * by_use[1], 1e-9);
  }
  EXPECT_GT(whole, 0);
  const fs::path out = fs::path(folder()) / "uses";
  EXPECT_TRUE(fs::is_regular_file(out / "uses-2.svg"));
  EXPECT_TRUE(fs::is_regular_file(out / "report" / "report.html"));
  EXPECT_TRUE(fs::is_regular_file(out / "report" / "figures" / "uses_2.svg"));
  EXPECT_TRUE(fs::is_regular_file(out / "use-2" / "report" / "report.html"));
  const Json& other = json.at("other_uses").at(0);
  EXPECT_NEAR(other.at("weight").get<double>(), 0.25, 1e-12);
  EXPECT_TRUE(other.contains("comparison"));
}

TEST(RedesignShape, TheTorqueThatFrictionHoldsIsAGoal) {
  const ProgramRun run =
      run_palmar("redesign shape " + kPrism +
                     " --goal torque --evaluations 2 --hands 2 --seed 2014 --no-pictures --quiet"
                     " --json --out torque",
                 folder());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json json = Json::parse(run.out);
  EXPECT_EQ(json.at("search").at("goal").at("key"), "held_torque_n_mm");
  // 60 N of grip force with friction of 0.5 on arms of 15 to 25 mm: sums of normal forces are 2 to
  // pi times the grip force.
  const double torque = json.at("search").at("original").get<double>();
  EXPECT_GT(torque, 0.5 * 2.0 * 60.0 * 0.5 * 15.0);
  EXPECT_LT(torque, 3.2 * 60.0 * 0.5 * 25.0);
  EXPECT_THAT(json.at("comparison").dump(), HasSubstr("held_torque_n_mm"));
}

TEST(RedesignShape, AFaceOfCadThatIsKeptStays) {
  const ProgramRun run =
      shape(kPrism +
            " --vary width=34 --vary depth=44 --vary squareness=0.2 --vary turn=0 --keep-face 1"
            " --json --out face" +
            kFew);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json json = Json::parse(run.out);
  EXPECT_EQ(json.at("kept_faces").at(0), "1");
  // Its outline is the original's within what a spline through 72 points makes of it.
  EXPECT_LT(json.at("kept_deviation_mm").get<double>(), 0.6);
  EXPECT_THAT(read_text(folder() + "/face/handle.toml"), HasSubstr("kept_faces = [\"1\"]"));
}

TEST(RedesignShape, FootAndTangOfAPistolGripStayAsTheyAre) {
  ASSERT_EQ(run_palmar("product make pistol_grip --out pistol.step", folder()).exit_code, 0);
  const ProgramRun run =
      shape("pistol.step --grip-force-n 60 --evaluations 2 --json --out pistol" + kFew);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json json = Json::parse(run.out);
  const auto kept = json.at("kept_ends_mm").get<std::array<double, 2>>();
  EXPECT_GT(kept[0] + kept[1], 3.0) << json.at("kept_ends_mm");
  // Foot and tang within what the spline makes of their edges, as above.
  EXPECT_LT(json.at("kept_deviation_mm").get<double>(), 0.6);
  EXPECT_THAT(run.err + json.dump(), HasSubstr("kept_ends_mm"));
  const ProgramRun all = shape(
      "pistol.step --grip-force-n 60 --evaluations 2 --keep-ends-mm 0 "
      "--json --out whole" +
      kFew);
  ASSERT_EQ(all.exit_code, 0) << all.err;
  EXPECT_TRUE(Json::parse(all.out).at("kept_deviation_mm").is_null());
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
