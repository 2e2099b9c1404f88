// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "run_program.h"

// Redesign 3 as a user runs it: features of CAD products changed and searched.

namespace palmar::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using Json = nlohmann::json;

const std::string kPrism = "\"made: prism width_mm=35 depth_mm=35 length_mm=100 fillet_mm=3\"";
const std::string kFew = " --hands 1 --seed 2014 --no-compare --quiet";

const std::string& folder() {
  static const std::string made = temporary_folder();
  return made;
}

ProgramRun redesign(const std::string& arguments) {
  return run_palmar("redesign " + arguments, folder());
}

TEST(RedesignFeatures, ASearchWritesAValidSolidAndItsHistory) {
  const ProgramRun run = redesign("fillet " + kPrism +
                                  " --radius-mm 2:12 --largest-offset-mm 3 --evaluations 3"
                                  " --step-mm 1 --json --out search" +
                                  kFew);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json json = Json::parse(run.out);
  const Json& history = json.at("history");
  ASSERT_GE(history.size(), 2U);
  ASSERT_LE(history.size(), 3U);
  EXPECT_EQ(history.at(0).at("values").at(0), 3.0);
  const Json& best = history.at(json.at("best").get<std::size_t>());
  EXPECT_TRUE(best.at("is_feasible").get<bool>());
  // The surface of an edge of 90 degrees moves by (sqrt 2 - 1) times the change of its radius.
  const double radius = best.at("values").at(0).get<double>();
  EXPECT_NEAR(best.at("constraints").at(0).get<double>(),
              (std::sqrt(2.0) - 1) * std::abs(radius - 3), 0.02);
  const double volume = 100 * (35 * 35 - (4 - M_PI) * radius * radius);
  EXPECT_NEAR(json.at("redesign").at("volume_mm3").get<double>(), volume, 1e-3 * volume);
  for (const char* file :
       {"redesign.step", "redesign.stl", "history.csv", "history.svg", "search.json"}) {
    EXPECT_TRUE(fs::is_regular_file(fs::path(folder()) / "search" / file)) << file;
  }
  const ProgramRun check = run_palmar("product check search/redesign.step", folder());
  EXPECT_EQ(check.exit_code, 0) << check.out << check.err;
}

TEST(RedesignFeatures, WhatThereIsNotIsReportedBeforeHandsAreMade) {
  struct Case {
    std::string arguments, message;
    int exit_code = 2;
  };
  for (const Case& one : {
           Case{"fillet " + kPrism + " --edges edge=99", "edge 99: the product has edges 1 to"},
           Case{"fillet " + kPrism + " --edges longest", "allowed are long, convex"},
           Case{"fillet " + kPrism + " --radius-mm 9:2", "from the smaller to the larger"},
           Case{"fillet " + kPrism + " --goal grip_force_n", "neither better higher nor lower"},
           Case{"fillet " + kPrism + " --goal peek", "did you mean peak"},
           Case{"features " + kPrism + " --vary width=20:30", "no parameter width"},
           Case{"features " + kPrism + " --vary chamfer:long=1:2", "fillet:EDGES, offset:FACES"},
           Case{"features " + kPrism, "--vary is needed"},
           Case{"features missing.step --vary fillet:long=1:2", "missing.step", 3},
       }) {
    const ProgramRun run = redesign(one.arguments + " --out none" + kFew);
    EXPECT_EQ(run.exit_code, one.exit_code) << one.arguments << run.err;
    EXPECT_THAT(run.err, HasSubstr(one.message)) << one.arguments;
    EXPECT_FALSE(fs::exists(fs::path(folder()) / "none"));
  }
}

TEST(RedesignFeatures, WhatChangesNothingIsTheOriginalAndIsntCompared) {
  const ProgramRun run = run_palmar(
      "redesign features " + kPrism + " --vary groove:at=0=0 --hands 1 --seed 2014 --out none",
      folder());
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, AllOf(HasSubstr("no change within the limits is better than the original"),
                             HasSubstr("nothing changes")));
  EXPECT_THAT(run.out, HasSubstr("+0.0 %"));
  EXPECT_FALSE(fs::exists(fs::path(folder()) / "none" / "redesign.step"));
}

TEST(RedesignFeatures, AMeshHasNoFeatures) {
  ASSERT_EQ(run_palmar("product make cylinder --out c.stl --quiet", folder()).exit_code, 0);
  const ProgramRun run =
      redesign("features c.stl --unit mm --vary fillet:long=1:2 --out none" + kFew);
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("c.stl: a mesh; features change in CAD files"));
}

TEST(RedesignFeatures, ARadiusThatLeavesNoRoomIsReportedWithItsValue) {
  const ProgramRun run = redesign("fillet " + kPrism + " --radius-mm 18 --out eighteen" + kFew);
  EXPECT_EQ(run.exit_code, 4);
  EXPECT_THAT(run.err, HasSubstr("fillet of 18 mm on fillets"));
}

TEST(RedesignFeatures, ThoroughWhatIsWorseByConstructionIsToldToBeWorse) {
  // A round bar of 12 mm fillets made sharp: hands of another sample than the one it was made in
  // must find it harder, held alike.
  const ProgramRun run = run_palmar(
      "redesign fillet \"made: prism width_mm=30 depth_mm=40 length_mm=130 fillet_mm=12\""
      " --edges long --radius-mm 1 --hands 6 --seed 2014 --grip-force-n 60 --json --quiet"
      " --out sharp",
      folder());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json json = Json::parse(run.out);
  const Json& comparison = json.at("comparison");
  EXPECT_TRUE(comparison.at("in_other_hands").get<bool>());
  EXPECT_FALSE(comparison.at("hold_changes").at(0).at("is_other_hold").get<bool>());
  const Json& trial = json.at("history").at(0);
  EXPECT_GT(trial.at("goal").get<double>(), 1.1 * json.at("original").get<double>());
  EXPECT_NEAR(trial.at("grip_force_ratio").get<double>(), 1.0, 0.01);
  // The sentence for people says so, too: redesign.palmar has both.
  const ProgramRun compared = run_palmar(
      "study compare sharp/redesign.palmar --quantity peak_pressure_cells_mpa", folder());
  EXPECT_EQ(compared.exit_code, 0) << compared.err;
  EXPECT_THAT(compared.out,
              ::testing::ContainsRegex("^prism 30 presses [0-9]+ % less than fillet:long 1 mm"));
}

}  // namespace
}  // namespace palmar::testing
