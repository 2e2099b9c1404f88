// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "run_program.h"

// `palmar contact press` as a whole: every option does what it says, and bad input ends with the
// documented exit code and a message that names the option, the value and what is allowed.

namespace palmar::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using Json = nlohmann::json;

constexpr const char* kSphere = "contact press --indenter sphere:20 --shear-modulus-kpa 50 ";

Json steps_of(const std::string& arguments) {
  const ProgramRun run = run_palmar(arguments + " --json");
  EXPECT_EQ(run.exit_code, 0) << arguments << "\n" << run.err;
  return run.exit_code == 0 ? Json::parse(run.out).at("steps") : Json::array();
}

double force_of(const std::string& arguments) {
  const Json steps = steps_of(arguments);
  return steps.empty() ? std::nan("") : steps[0].at("force_n").get<double>();
}

TEST(PressCommand, LayerMeetsTheTable) {
  // sqrt(R d) / h = 1: 5.1154 times Hertz (closed form 5 of the validation cases).
  EXPECT_NEAR(force_of(kSphere + std::string("--depth-mm 2 --layer-mm 6.32456")), 5.1154 * 3.3731,
              0.01 * 5.1154 * 3.3731);
}

TEST(PressCommand, PoissonsRatioStiffensByOneMinusNu) {
  const double incompressible = force_of(kSphere + std::string("--depth-mm 2"));
  EXPECT_NEAR(force_of(kSphere + std::string("--depth-mm 2 --poisson 0.3")),
              incompressible * 0.5 / 0.7, 1e-6);
}

TEST(PressCommand, SoftCoverTakesForceAway) {
  const double rigid = force_of(kSphere + std::string("--depth-mm 2"));
  const double covered = force_of(kSphere + std::string("--depth-mm 2 --coating 3,50,0.4"));
  EXPECT_LT(covered, 0.95 * rigid);
  EXPECT_GT(covered, 0.5 * rigid);
}

TEST(PressCommand, TheCoverInItsOldWordsIsTheSame) {
  EXPECT_EQ(force_of(kSphere + std::string("--depth-mm 2 --coating-mm 3 --coating-modulus-kpa 50 "
                                           "--coating-poisson 0.4")),
            force_of(kSphere + std::string("--depth-mm 2 --coating 3,50,0.4")));
}

TEST(PressCommand, TwoPunchesLoseForceToEachOther) {
  // Three radii apart each carries 0.82 of what it would alone (8 G a depth).
  EXPECT_NEAR(force_of("contact press --indenter punches:5,15 --shear-modulus-kpa 50 --depth-mm 1"),
              0.82 * 4.0, 0.01 * 4.0);
}

TEST(PressCommand, ForceControlOnSkinMeetsTheForce) {
  for (const std::string more : {"--indenter sphere:5", "--indenter plane --tilt-deg 30",
                                 "--indenter punches:2,8", "--indenter cylinder:10"}) {
    const Json steps =
        steps_of("contact press --specimen template:middle_distal --force-n 0.5,2 " + more);
    ASSERT_EQ(steps.size(), 2u) << more;
    EXPECT_NEAR(steps[0].at("force_n").get<double>(), 0.5, 0.5e-3) << more;
    EXPECT_NEAR(steps[1].at("force_n").get<double>(), 2.0, 2e-3) << more;
    EXPECT_LT(steps[1].at("relative_residual").get<double>(), 1e-6) << more;
  }
}

TEST(PressCommand, LevelsOfTheTissueStandInOrder) {
  const std::string press =
      "contact press --specimen template:index_distal --indenter plane --depth-mm 2 ";
  const double low = force_of(press + "--tissue-level low");
  const double nominal = force_of(press);
  const double high = force_of(press + "--tissue-level high");
  EXPECT_LT(low, nominal);
  EXPECT_LT(nominal, high);
}

TEST(PressCommand, WritesTheFormatThatTheNameAsksFor) {
  const std::string folder = temporary_folder();
  const std::string press = kSphere + std::string("--depth-mm 0.5,1,2 --out ");
  for (const std::string name : {"curve.json", "curve.csv", "curve.svg"}) {
    const ProgramRun run = run_palmar(press + name, folder);
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  EXPECT_EQ(Json::parse(read_text(folder + "/curve.json")).at("steps").size(), 3u);
  const std::string csv = read_text(folder + "/curve.csv");
  EXPECT_THAT(csv, StartsWith("depth_mm,force_n,contact_area_mm2,peak_pressure_mpa,"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 4);
  EXPECT_THAT(read_text(folder + "/curve.svg"),
              AllOf(StartsWith("<svg"), HasSubstr("Force, N"), HasSubstr("Depth, mm")));
}

class PressBadInput : public ::testing::Test {
 protected:
  static void expect_usage_error(const std::string& arguments, const std::string& name,
                                 const std::string& text) {
    const ProgramRun run = run_palmar("contact press " + arguments);
    EXPECT_EQ(run.exit_code, 2) << arguments << "\n" << run.err;
    EXPECT_THAT(run.err, AllOf(HasSubstr(name), HasSubstr(text))) << arguments;
    EXPECT_EQ(run.out, "") << arguments;
  }
};

TEST_F(PressBadInput, Indenter) {
  expect_usage_error("--indenter cone:3 --depth-mm 1", "cone:3", "punches:A,DISTANCE");
  expect_usage_error("--indenter sphere --depth-mm 1", "sphere", "radius in mm");
  expect_usage_error("--indenter sphere:0 --depth-mm 1", "radius of the indenter is 0 mm", "0.1");
  expect_usage_error("--indenter punches:2 --depth-mm 1", "--indenter", "punches:2,10");
  expect_usage_error("--indenter punches:2,3 --depth-mm 1", "distance of the punches is 3 mm",
                     "diameter");
  expect_usage_error("--indenter plane --depth-mm 1", "plane on a plane", "without end");
  expect_usage_error("--indenter sphere:nan --depth-mm 1", "--indenter", "\"nan\" is not a number");
}

TEST_F(PressBadInput, Specimen) {
  expect_usage_error("--specimen cube --indenter plane --depth-mm 1", "\"cube\"", "ellipsoid:RX");
  expect_usage_error("--specimen ellipsoid:3 --indenter plane --depth-mm 1", "ellipsoid:3",
                     "two radii");
  expect_usage_error("--specimen template:elbow --indenter plane --depth-mm 1", "elbow",
                     "HAND:REGION");
  const ProgramRun run =
      run_palmar("contact press --specimen nobody.hand.glb:thenar --indenter plane --depth-mm 1");
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_THAT(run.err, HasSubstr("nobody.hand.glb"));
}

TEST_F(PressBadInput, DepthsAndForces) {
  expect_usage_error("--indenter sphere:5", "--depth-mm", "--force-n");
  expect_usage_error("--indenter sphere:5 --depth-mm 1 --force-n 1", "--depth-mm", "only one");
  expect_usage_error("--indenter sphere:5 --depth-mm 1,x", "--depth-mm", "x");
  expect_usage_error("--indenter sphere:5 --depth-mm 0", "depth is 0 mm", "more than 0");
  expect_usage_error("--indenter sphere:5 --depth-mm 6", "depth is 6 mm", "radius");
  expect_usage_error("--indenter sphere:5 --force-n -1", "force is -1 N", "more than 0");
}

TEST_F(PressBadInput, TissueAndCover) {
  const std::string sphere = "--indenter sphere:5 --depth-mm 1 ";
  expect_usage_error(sphere + "--layer-mm 0", "thickness of the layer is 0 mm", "0.05");
  expect_usage_error(sphere + "--poisson 0.51", "Poisson's ratio is 0.51", "0 to 0.5");
  expect_usage_error(sphere + "--tissue-model layered", "layered", "--layer-mm");
  expect_usage_error(sphere + "--tissue-model bone", "bone", "has no bones");
  expect_usage_error(sphere + "--tissue-model foam", "\"foam\"", "halfspace, layered or bone");
  expect_usage_error(sphere + "--tissue-model halfspace --layer-mm 4", "--layer-mm", "exclude");
  expect_usage_error(sphere + "--tissue-level soft", "\"soft\"", "low, nominal or high");
  expect_usage_error(sphere + "--preset xie2013", "\"xie2013\"", "palmar or xie2014");
  expect_usage_error(sphere + "--kernel point --layer-mm 4", "kernel \"point\"", "layer");
  expect_usage_error(sphere + "--coating 2", "\"2\"", "shear modulus in kPa");
  expect_usage_error(sphere + "--coating=-2,100", "thickness is -2", "0.05 to 50 mm");
  expect_usage_error(sphere + "--coating 2,100,0.7", "ratio is 0.7", "0 to 0.5");
  expect_usage_error(sphere + "--coating 2,100,0.5,0,0,0,1,1,1", "all round", "2 or 3 numbers");
  expect_usage_error(sphere + "--coating-mm 2", "--coating-modulus-kpa", "together");
  expect_usage_error(sphere + "--shear-modulus-kpa 0", "--shear-modulus-kpa is 0", "more than 0");
  expect_usage_error(sphere + "--spacing-mm 0", "spacing is 0 mm", "0.05 to 10 mm");
  expect_usage_error(sphere + "--tilt-deg 80", "tilt is 80 deg", "-60 to 60");
  expect_usage_error("--specimen template:thenar --indenter plane --depth-mm 1 --layer-mm 5",
                     "a hand has its own bones", "layered");
}

TEST_F(PressBadInput, OutputFile) {
  expect_usage_error("--indenter sphere:5 --depth-mm 1 --out curve.xls", "curve.xls", ".csv");
}

TEST_F(PressBadInput, ForceOutOfReach) {
  const ProgramRun run =
      run_palmar("contact press --indenter sphere:2 --shear-modulus-kpa 1 --force-n 100");
  EXPECT_EQ(run.exit_code, 4) << run.err;
  EXPECT_THAT(run.err, AllOf(HasSubstr("100 N is not reached within 2 mm")));
}

}  // namespace
}  // namespace palmar::testing
