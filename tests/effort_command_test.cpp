// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "run_program.h"

// Muscle effort as a user asks for it: palmar effort fingertip, palmar effort grasp.

namespace palmar::testing {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

ProgramRun fingertip(const std::string& arguments) {
  return run_palmar("effort fingertip " + arguments, temporary_folder());
}

Json fingertip_json(const std::string& arguments) {
  const ProgramRun run = fingertip(arguments + " --json");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  return run.exit_code == 0 ? Json::parse(run.out) : Json::object();
}

TEST(EffortCommand, ProfundusPressesTheFingertipPalmarly) {
  // Cadavers give 0.25 N per N in this posture (Synek et al. 2019), nearly all of it palmar.
  const Json tip =
      fingertip_json("--finger middle --posture mcp=40,pip=55,dip=35 --tendon fdp --force-n 1");
  const auto force = tip.at("fingertip_force_n").get<std::vector<double>>();
  ASSERT_EQ(force.size(), 3U);
  const double magnitude = tip.at("fingertip_force_magnitude_n").get<double>();
  EXPECT_NEAR(std::hypot(force[0], force[1], force[2]), magnitude, 1e-12);
  EXPECT_GT(magnitude, 0.2);
  EXPECT_LT(magnitude, 0.3);
  EXPECT_GT(tip.at("fingertip_force_distal_phalanx_n").at("palmar").get<double>(), 0.9 * magnitude);
  // Bent by 130 degrees in all, palmar of the phalanx is proximal (-y) and dorsal (-z) of the hand.
  EXPECT_LT(force[1], 0.0);
  EXPECT_LT(force[2], 0.0);
}

TEST(EffortCommand, EveryFingerAndTendonAnswers) {
  for (const std::string finger : {"index", "middle", "ring", "little"}) {
    const Json all = fingertip_json("--finger " + finger + " --posture mcp=30,pip=40,dip=30");
    EXPECT_EQ(all.at("tendons").size(), 6U);
  }
  const Json thumb = fingertip_json("--finger thumb --posture cmc-abduction=20,mp=20,ip=30");
  EXPECT_EQ(thumb.at("tendons").size(), 8U);
  EXPECT_THAT(fingertip("--finger thumb --posture mp=20,ip=30").out, HasSubstr("fpl"));
}

/// Moment arms of `--tendon all`: tendon, then angle without the finger's name.
std::map<std::string, std::map<std::string, double>> arms_of(const std::string& arguments) {
  std::map<std::string, std::map<std::string, double>> arms;
  const Json all = fingertip_json(arguments);
  for (const Json& tendon : all.at("tendons")) {
    for (const Json& joint : tendon.at("joints")) {
      const auto angle = joint.at("angle").get<std::string>();
      arms[tendon.at("tendon").get<std::string>()][angle.substr(angle.find('_') + 1)] =
          joint.at("moment_arm_mm").get<double>();
    }
  }
  return arms;
}

TEST(EffortCommand, ThumbMusclesActAsInCadavers) {
  // Smutz et al. 1998 (abstract): what each muscle does at the CMC.
  auto arms = arms_of("--finger thumb --posture cmc-abduction=25,mp=15,ip=20");
  for (const std::string flexor : {"fpl", "fpb", "adp", "opp"}) {
    EXPECT_GT(arms[flexor]["cmc_flexion"], 3.0) << flexor;
  }
  for (const std::string extensor : {"epl", "epb", "apl"}) {
    EXPECT_LT(arms[extensor]["cmc_flexion"], -3.0) << extensor;
  }
  for (const std::string abductor : {"apb", "apl", "opp"}) {
    EXPECT_GT(arms[abductor]["cmc_abduction"], 0.0) << abductor;
  }
  for (const std::string adductor : {"adp", "epl", "fpb"}) {
    EXPECT_LT(arms[adductor]["cmc_abduction"], 0.0) << adductor;
  }
  EXPECT_LT(arms["epl"]["ip_flexion"], -3.0);
  EXPECT_LT(arms["epb"]["mp_flexion"], -2.0);
  // Straight lines through the specimen of Mirakhorlo et al. 2016 as it was: 7.04 and 10.25 mm;
  // ours is another hand in another posture.
  EXPECT_NEAR(arms["fpl"]["ip_flexion"], 7.04, 0.2 * 7.04);
  EXPECT_NEAR(arms["fpl"]["mp_flexion"], 10.25, 0.3 * 10.25);
}

TEST(EffortCommand, FingersDifferAsInCadavers) {
  // Arms over those of the middle finger (Ketchum et al. 1978, 11.6 mm at the MCP, 10.7 at the
  // PIP).
  const struct {
    const char* finger;
    double mcp, pip;
  } cadavers[] = {{"index", 10.1 / 11.6, 9.8 / 10.7},
                  {"ring", 10.4 / 11.6, 10.4 / 10.7},
                  {"little", 8.9 / 11.6, 8.5 / 10.7}};
  const std::string posture = " --posture mcp=40,pip=40,dip=30";
  auto middle = arms_of("--finger middle" + posture);
  for (const auto& c : cadavers) {
    auto arms = arms_of(std::string("--finger ") + c.finger + posture);
    // Hands differ: the template's index is as wide as its middle finger.
    EXPECT_NEAR(arms["fdp"]["mcp_flexion"] / middle["fdp"]["mcp_flexion"], c.mcp, 0.16) << c.finger;
    EXPECT_NEAR(arms["fdp"]["pip_flexion"] / middle["fdp"]["pip_flexion"], c.pip, 0.16) << c.finger;
  }
}

TEST(EffortCommand, BadFingertipInputIsNamed) {
  const struct {
    const char *arguments, *message;
    int code;
  } cases[] = {
      {"--finger toe", "thumb, index, middle, ring or little", 2},
      {"--finger middle --tendon fpl", "it has fdp, fds, edc, lum, ri, ui", 2},
      {"--finger middle --posture mcp=140", "mcp is 140 deg; the range of middle MCP flexion", 2},
      {"--finger middle --posture mpcp=10", "no angle \"mpcp\"", 2},
      {"--finger middle --posture mcp=bent", "NAME=DEGREES", 2},
      {"--finger middle --posture mcp=1,mcp=2", "given twice", 2},
      {"--finger thumb --posture pip=10", "it has cmc-flexion, cmc-abduction, mp, ip", 2},
      {"--finger middle --posture mcp=40,pip=55,dip=35 --force-n 0", "above 0 and at most 1000", 2},
      {"--finger middle --posture mcp=40,pip=55,dip=35 --force-n 5000", "at most 1000 N", 2},
      {"--finger middle --hood wide", "synek2019 or chao1989", 2},
      {"--finger middle --posture mcp=30", "too straight", 4},
      {"--finger middle --hand nobody.hand.glb --posture pip=40,dip=30", "nobody.hand.glb", 3}};
  for (const auto& c : cases) {
    const ProgramRun run = fingertip(c.arguments);
    EXPECT_EQ(run.exit_code, c.code) << c.arguments << "\n" << run.err;
    EXPECT_THAT(run.err, HasSubstr(c.message)) << c.arguments;
  }
}

TEST(EffortCommand, GraspGivesTheForcesOfEveryMuscle) {
  const std::string folder = temporary_folder();
  ASSERT_EQ(
      run_palmar("product make cylinder --diameter-mm 50 --length-mm 140 --out bar.stl", folder)
          .exit_code,
      0);
  const ProgramRun run = run_palmar("effort grasp bar.stl --unit mm --json", folder);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json effort = Json::parse(run.out);
  ASSERT_EQ(effort.at("digits").size(), 5U);
  EXPECT_GT(effort.at("tendon_force_n").get<double>(), effort.at("contact_force_n").get<double>());
  EXPECT_EQ(effort.at("with_friction"), true);  // of the grasp at rest
  for (const Json& digit : effort.at("digits")) {
    if (digit.at("status") == "no_load") continue;
    EXPECT_LT(digit.at("kkt_residual").get<double>(), 1e-6);
    for (const Json& joint : digit.at("joints")) {
      EXPECT_NEAR(joint.at("external_moment_n_mm").get<double>() +
                      joint.at("muscle_moment_n_mm").get<double>() +
                      joint.at("stop_moment_n_mm").get<double>() +
                      joint.at("missing_moment_n_mm").get<double>(),
                  0.0, 0.01);
    }
  }
  const ProgramRun text = run_palmar("effort grasp bar.stl --unit mm", folder);
  EXPECT_THAT(text.out, HasSubstr("activation"));
  const ProgramRun bad = run_palmar("effort grasp bar.stl --unit mm --exponent 5", folder);
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_THAT(bad.err, HasSubstr("exponent is 5; 2 or 3"));
}

}  // namespace
}  // namespace palmar::testing
