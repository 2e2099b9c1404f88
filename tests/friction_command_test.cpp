// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

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
  EXPECT_GT(held.at("slip_margin").get<double>(), 0.0);

  // The same ten times lighter can be held ten times as often, but for the little by which the hand
  // presses less; a thousand times heavier slips.
  const ProgramRun feather = assess("--friction 0.6 --mass-kg 0.03 --json");
  const Json lighter = Json::parse(feather.out).at("assessments").at(0).at("friction");
  EXPECT_NEAR(lighter.at("load_factor").get<double>() / held.at("load_factor").get<double>(), 10.0,
              0.6);
  const ProgramRun anvil = assess("--friction 0.6 --mass-kg 300");
  EXPECT_EQ(anvil.exit_code, 0);
  EXPECT_THAT(anvil.out,
              AllOf(HasSubstr("the product slips"), HasSubstr("friction holds at most")));
  EXPECT_THAT(read_text(folder() + "/report/report.html"),
              AllOf(HasSubstr("It slips."), HasSubstr("Friction per region")));
  EXPECT_THAT(read_text(folder() + "/report/bar/hand.vtp"), HasSubstr("mobilised_friction"));
}

// A bar that lies in hooked fingers hangs across its axis; friction is asked for the same load.
TEST(FrictionCommand, WhatHangsHasOneLoadInTheWholeReport) {
  const auto load = [](const std::string& gravity) {
    const ProgramRun run = assess("--grip fixed_hook --weight-n 20 --json" + gravity);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return Json::parse(run.out).at("assessments").at(0).at("friction");
  };
  const Json hangs = load("");
  const auto down = hangs.at("given").at("gravity").get<std::vector<double>>();
  EXPECT_LT(std::abs(down[2]), 0.5);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(hangs.at("load").at("force_n").at(c).get<double>(), 20.0 * down[c], 1e-9);
  }
  const Json given = load(" --gravity 1,0,0");
  EXPECT_NEAR(given.at("load").at("force_n").at(0).get<double>(), 20.0, 1e-9);
}

TEST(FrictionCommand, IsLeftOutUnlessAskedFor) {
  const ProgramRun plain = assess("--json");
  ASSERT_EQ(plain.exit_code, 0) << plain.err;
  EXPECT_THAT(plain.out, Not(HasSubstr("\"friction\"")));
}

TEST(FrictionCommand, ALoadIsHeldWithUsualFrictionIfNoneIsGiven) {
  const ProgramRun run = assess("--weight-n 3 --json");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json one = Json::parse(run.out).at("assessments").at(0);
  EXPECT_EQ(one.at("friction").at("coefficient"), 0.5);
  EXPECT_EQ(one.at("balance").at("status"), "balanced");
}

TEST(FrictionCommand, WeightComesFromDensityAndVolume) {
  // 40 mm x 140 mm: 175.9 cm3 (of a polygon a little less); standard gravity.
  const ProgramRun run = assess("--density-g-cm3 2 --json");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json one = Json::parse(run.out).at("assessments").at(0);
  EXPECT_NEAR(-one.at("friction").at("load").at("force_n").at(2).get<double>(),
              3.14159265 * 4.0 * 14.0 * 2e-3 * 9.80665, 0.02);
}

TEST(FrictionCommand, AnOpenSurfaceHasNoMassOfItsOwn) {
  write_text(folder() + "/open.obj",
             "v 0 0 0\nv 40 0 0\nv 40 140 0\nv 0 140 0\nv 0 0 30\nv 0 140 30\n"
             "f 1 2 3\nf 1 3 4\nf 1 4 6\nf 1 6 5\n");
  const ProgramRun run =
      run_palmar("assess open.obj --unit mm --no-pictures --out open --density-g-cm3 1", folder());
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, AllOf(HasSubstr("open"), HasSubstr("its surface is open along"),
                             HasSubstr("--mass-at")));
}

TEST(FrictionCommand, GripForceAndStrengthAreAskedFor) {
  const ProgramRun firm = assess("--grip-force-n 50 --json");
  ASSERT_EQ(firm.exit_code, 0) << firm.err;
  const Json balance = Json::parse(firm.out).at("assessments").at(0).at("balance");
  EXPECT_NEAR(balance.at("grip_force_n").get<double>(), 50.0, 0.5);
  // 10 % of 53.5 kg (Steiber 2016, men of 30-34 years).
  const ProgramRun share = assess("--strength-share 0.1 --person male,31 --json");
  ASSERT_EQ(share.exit_code, 0) << share.err;
  EXPECT_NEAR(
      Json::parse(share.out).at("assessments").at(0).at("balance").at("grip_force_n").get<double>(),
      52.47, 0.6);
  const ProgramRun still = assess("--no-balance --json");
  EXPECT_EQ(Json::parse(still.out).at("assessments").at(0).at("balance").at("status"), "off");
  for (const auto& [arguments, text] :
       {std::pair{"--strength-share 0.5", "--strength-share needs --person or --strength-n"},
        {"--person male,31", "--strength-share is required"},
        {"--strength-share 2 --strength-n 300", "--strength-share is 2"},
        {"--strength-share 0.2 --person child,31", "woman or man is required"},
        {"--strength-share 0.2 --person male,7", "17 to 90"},
        {"--no-balance --grip-force-n 5", "--no-balance"},
        {"--limit-depths --grip-force-n 5",
         "--limit-depths and --grip-force-n both say how firmly"},
        {"--limit-depths --no-balance", "one is allowed"},
        {"--acceleration-g 0.5", "--acceleration-g needs what is accelerated: --mass-kg"},
        {"--grip-force-n 0", "grip force is 0 N"}}) {
    const ProgramRun run = assess(arguments);
    EXPECT_EQ(run.exit_code, 2) << arguments;
    EXPECT_THAT(run.err, HasSubstr(text));
  }
}

TEST(FrictionCommand, UsualGripForceIsSaidWithItsSource) {
  const ProgramRun usual = assess("");
  ASSERT_EQ(usual.exit_code, 0) << usual.err;
  EXPECT_THAT(usual.out, HasSubstr("grip force: 107 N, 25 % of what women and men of 45 years "
                                   "(mean; Steiber 2016) reach on a dynamometer, 427 N"));
  EXPECT_THAT(read_text(folder() + "/report/report.html"),
              HasSubstr("asked to grip with 107 N (25 % of what women and men"));
  const ProgramRun depths = assess("--limit-depths --json");
  ASSERT_EQ(depths.exit_code, 0) << depths.err;
  const Json one = Json::parse(depths.out).at("assessments").at(0);
  EXPECT_TRUE(one.at("settings").at("grip_force_asked_n").is_null());
  EXPECT_EQ(one.at("balance").at("status"), "balanced");
}

TEST(FrictionCommand, AccelerationAddsToTheWeight) {
  const ProgramRun run = assess("--weight-n 4 --acceleration-g 0.5 --json");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json friction = Json::parse(run.out).at("assessments").at(0).at("friction");
  EXPECT_NEAR(friction.at("load").at("force_n").at(2).get<double>(), -6.0, 1e-12);
}

TEST(FrictionCommand, RefusesWhatMakesNoSense) {
  const auto expect_refused = [](const std::string& arguments, const std::string& text) {
    const ProgramRun run = assess(arguments);
    EXPECT_EQ(run.exit_code, 2) << arguments;
    EXPECT_THAT(run.err, HasSubstr(text));
  };
  expect_refused("--friction -0.1", "--friction is -0.1; 0 to 5 is required");
  expect_refused("--mass-kg 0", "--mass-kg is 0");
  expect_refused("--density-g-cm3 0", "--density-g-cm3 is 0");
  expect_refused("--friction 0.5 --mass-kg -1", "--mass-kg is -1");
  expect_refused("--friction 0.5 --mass-kg 1 --gravity 0,0,0", "--gravity is 0,0,0");
  expect_refused("--friction 0.5 --load-n 1,2", "--load-n");
  expect_refused("--friction 0.5 --mass-kg 1 --weight-n 9", "--mass-kg");
}

}  // namespace
}  // namespace palmar::testing
