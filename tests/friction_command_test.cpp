// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "run_program.h"

// Friction as a user asks for it: palmar assess --friction.

namespace palmar::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

/// A 40 mm cylinder along z, made once.
const std::string& folder() {
  static const std::string made = [] {
    std::string name = temporary_folder();
    run_palmar("product make cylinder --diameter-mm 40 --length-mm 140 --out bar.stl", name);
    return name;
  }();
  return made;
}

ProgramRun assess(const std::string& arguments) {
  return run_palmar("assess bar.stl --unit mm --no-pictures --out report " + arguments, folder());
}

TEST(FrictionCommand, SaysHeldOrSlipsAndEndsWellBothTimes) {
  const ProgramRun light = assess("--friction 0.6 --mass-kg 0.3 --json");
  ASSERT_EQ(light.exit_code, 0) << light.err;
  const Json held = Json::parse(light.out).at("assessments").at(0).at("friction");
  EXPECT_EQ(held.at("status"), "held");
  EXPECT_GT(held.at("load_factor").get<double>(), 1.0);
  EXPECT_NEAR(held.at("load").at("force_n").at(2).get<double>(), -0.3 * 9.80665, 1e-12);
  double margin = 1.0;
  for (const Json& region : held.at("regions")) {
    margin = std::min(margin, region.at("slip_margin").get<double>());
  }
  EXPECT_GT(margin, 0.0);

  // The same ten times lighter can be held ten times as often; a thousand times heavier slips.
  const ProgramRun feather = assess("--friction 0.6 --mass-kg 0.03 --json");
  const Json lighter = Json::parse(feather.out).at("assessments").at(0).at("friction");
  EXPECT_NEAR(lighter.at("load_factor").get<double>() / held.at("load_factor").get<double>(), 10.0,
              1e-4);
  const ProgramRun anvil = assess("--friction 0.6 --mass-kg 300");
  EXPECT_EQ(anvil.exit_code, 0);
  EXPECT_THAT(anvil.out, AllOf(HasSubstr("SLIPS"), HasSubstr("friction holds at most")));
  EXPECT_THAT(read_text(folder() + "/report/report.html"),
              AllOf(HasSubstr("Slips."), HasSubstr("Friction per region")));
  EXPECT_THAT(read_text(folder() + "/report/bar/hand.vtp"), HasSubstr("mobilised_friction"));
}

TEST(FrictionCommand, IsLeftOutUnlessAskedFor) {
  const ProgramRun plain = assess("--json");
  ASSERT_EQ(plain.exit_code, 0) << plain.err;
  EXPECT_THAT(plain.out, Not(HasSubstr("\"friction\"")));
}

TEST(FrictionCommand, RefusesWhatMakesNoSense) {
  const auto expect_refused = [](const std::string& arguments, const std::string& text) {
    const ProgramRun run = assess(arguments);
    EXPECT_EQ(run.exit_code, 2) << arguments;
    EXPECT_THAT(run.err, HasSubstr(text));
  };
  expect_refused("--mass-kg 1", "--friction with the coefficient is required");
  expect_refused("--friction 0", "--friction is 0; more than 0 and at most 5 is required");
  expect_refused("--friction 0.5 --mass-kg -1", "--mass-kg is -1");
  expect_refused("--friction 0.5 --mass-kg 1 --gravity 0,0,0", "--gravity is 0,0,0");
  expect_refused("--friction 0.5 --load-n 1,2", "--load-n");
  expect_refused("--friction 0.5 --mass-kg 1 --weight-n 9", "--mass-kg");
}

}  // namespace
}  // namespace palmar::testing
