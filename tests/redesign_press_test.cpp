// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// `palmar redesign press` as a whole: the solid of a pressed handle beside its mesh.
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>

#include "gmock/gmock.h"
#include "run_program.h"

namespace palmar::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using ::testing::HasSubstr;

constexpr const char* kFew = " --hands 2 --seed 7 --no-compare --no-pictures --json --out pressed";

TEST(RedesignPress, GivesASolidOfTheVolumeThatTheMeshHas) {
  const std::string folder = temporary_folder();
  const ProgramRun run = run_palmar(
      "redesign press \"made: cylinder diameter_mm=45 length_mm=120\"" + std::string(kFew), folder);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json json = Json::parse(run.out);
  const Json& solid = json.at("solid");
  EXPECT_EQ(fs::path(solid.at("file").get<std::string>()).filename(), "pressed.step");
  EXPECT_LT(solid.at("rms_deviation_mm").get<double>(), 0.05);
  EXPECT_LT(solid.at("largest_deviation_mm").get<double>(), 0.5);
  // The cylinder less what the mesh lost and the edges of its ends: a rounding over 75 degrees
  // takes r^2 (s - a / 2 - s c / 2 - s (1 - c)) = 0.37 r^2 of their section there (s, c: sine and
  // cosine of the angle a), round the circle.
  const double r = solid.at("end_radius_mm").get<double>();
  EXPECT_NEAR(r, 3.0, 1e-9);
  const double angle = 75.0 / 180.0 * std::numbers::pi;
  const double s = std::sin(angle), c = std::cos(angle);
  const double section = r * r * (s - 0.5 * angle - 0.5 * s * c);
  const double cylinder = std::numbers::pi * 22.5 * 22.5 * 120.0;
  const double removed = json.at("figures").at("removed_volume_mm3").get<double>();
  EXPECT_GT(removed, 0.005 * cylinder);
  const double ends = 2.0 * section * 2.0 * std::numbers::pi * 21.8;
  EXPECT_NEAR(solid.at("volume_mm3").get<double>(), cylinder - removed - ends, 1e-3 * cylinder);
  // What the program says of the file when it opens it as any other.
  const ProgramRun info = run_palmar("product info pressed/pressed.step", folder);
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_THAT(info.out, HasSubstr("1 solid"));
  EXPECT_THAT(info.out, HasSubstr("verdict: ok"));
}

TEST(RedesignPress, SaysWhyThereIsNoSolid) {
  const std::string folder = temporary_folder();
  const ProgramRun run = run_palmar(
      "redesign press \"made: cylinder diameter_mm=45 length_mm=120\" --at 0,0,0 "
      "--axis 0,0,1" +
          std::string(kFew),
      folder);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_FALSE(Json::parse(run.out).contains("solid"));
  EXPECT_THAT(run.err, HasSubstr("no STEP file of the pressed shape: cylinder"));
  EXPECT_THAT(run.err, HasSubstr("held at given coordinates"));
  EXPECT_FALSE(fs::exists(fs::path(folder) / "pressed" / "pressed.step"));
  EXPECT_TRUE(fs::exists(fs::path(folder) / "pressed" / "pressed.stl"));
}

}  // namespace
}  // namespace palmar::testing
