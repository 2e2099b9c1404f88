// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "run_program.h"

// hand pose from angles, markers and meshes, and grasp evaluate, as a user runs them.

namespace palmar::testing {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

const std::string kMarkers =
    "--markers " + std::string(PALMAR_SOURCE_DIR) + "/examples/closing-hand-markers.csv";

TEST(HandPoseCommand, AnglesGoThroughJsonAndCsvUnchanged) {
  const std::string folder = temporary_folder();
  const ProgramRun first = run_palmar("hand pose --posture tripod --out a.csv --json", folder);
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const ProgramRun second = run_palmar("hand pose --angles a.csv --out b.json", folder);
  ASSERT_EQ(second.exit_code, 0) << second.err;
  const Json a = Json::parse(first.out), b = Json::parse(read_text(folder + "/b.json"));
  for (const auto& [name, angle] : a.at("posture").items()) {
    EXPECT_NEAR(b.at("posture").at(name).get<double>(), angle.get<double>(), 1e-12) << name;
  }
  EXPECT_EQ(a.at("posture").size(), 23U);
}

TEST(HandPoseCommand, WhatIsNotGivenOrClampedIsReported) {
  const std::string folder = temporary_folder();
  write_text(folder + "/some.json", R"({"index_pip_flexion_deg": 140})");
  const ProgramRun run = run_palmar("hand pose --angles some.json --json", folder);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("22 of 23 angles are not given"));
  EXPECT_THAT(run.err, HasSubstr("140.0 deg is outside the range of motion; 100.0 deg is used"));
  EXPECT_NEAR(Json::parse(run.out).at("clamped").at("index_pip_flexion").at("asked_deg"), 140,
              1e-9);
}

TEST(HandPoseCommand, ARecordingGivesAPosturePerFrame) {
  // The example closes from flat to a cylinder grip in 5 frames, noise 0.5 mm per axis.
  const std::string folder = temporary_folder();
  const ProgramRun run = run_palmar(
      "hand pose " + kMarkers + " --marker-height-mm 6 --out p.json --out p.csv", folder);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json frames = Json::parse(read_text(folder + "/p.json")).at("frames");
  ASSERT_EQ(frames.size(), 5U);
  // 75 numbers less 29 unknowns: 0.5 sqrt(3 (1 - 29 / 75)) = 0.68 mm expected.
  for (const Json& frame : frames) EXPECT_NEAR(frame.at("rms_mm").get<double>(), 0.68, 0.3);
  EXPECT_EQ(frames[4].at("frame"), 5);
  EXPECT_TRUE(frames[4].at("residuals_mm").at("little_nail").is_null());
  EXPECT_THAT(frames[4].at("not_observed").dump(), HasSubstr("little_dip_flexion"));
  EXPECT_THAT(run.err, HasSubstr("5 frames"));
  std::istringstream csv(read_text(folder + "/p.csv"));
  std::string line;
  int lines = 0;
  while (std::getline(csv, line)) ++lines;
  EXPECT_EQ(lines, 6);
  // Index PIP: 0 flat to 50 degrees in the grip.
  EXPECT_NEAR(frames[4].at("posture").at("index_pip_flexion_deg").get<double>(), 50, 8);
  EXPECT_EQ(run_palmar("hand pose --angles p.json --frame 5 --out last.ply", folder).exit_code, 0);
}

TEST(HandPoseCommand, AMarkerSetOfOnesOwn) {
  const std::string folder = temporary_folder();
  write_text(folder + "/set.csv",
             "label,landmark,vertex,part,x_mm,y_mm,z_mm,height_mm\n"
             "K2,index_mcp_dorsal,,,,,,6\n"
             "K5,little_mcp_dorsal,,,,,,6\n"
             "BASE,,,palm,0,30,-12,\n"
             "SIDE,,,,45,50,35,\n"
             "V,,1200,,,,,2\n");
  // Frame written from the set itself: the hand in its reference posture, moved by 100 mm in x.
  write_text(folder + "/set.json",
             R"({"markers": [{"label": "P1", "part": "palm", "point_mm": [0, 30, -12]},
                             {"label": "P2", "part": "palm", "point_mm": [25, 70, -8]},
                             {"label": "P3", "part": "palm", "point_mm": [-30, 60, -5]},
                             {"label": "P4", "part": "palm", "point_mm": [-20, 30, 25]}]})");
  write_text(folder + "/take.csv",
             "P1_x_mm,P1_y_mm,P1_z_mm,P2_x_mm,P2_y_mm,P2_z_mm,P3_x_mm,P3_y_mm,P3_z_mm,"
             "P4_x_mm,P4_y_mm,P4_z_mm\n100,30,-12,125,70,-8,70,60,-5,80,30,25\n");
  const ProgramRun run =
      run_palmar("hand pose --markers take.csv --marker-set set.json --json", folder);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json found = Json::parse(run.out);
  const Json t = found.at("measured_from_hand").at("translation_mm");
  EXPECT_NEAR(t[0].get<double>(), 100, 1e-3);
  EXPECT_NEAR(t[1].get<double>(), 0, 1e-3);
  EXPECT_EQ(found.at("not_observed").size(), 23U);  // markers on the palm show no angle
  const ProgramRun other = run_palmar("hand pose --markers take.csv --marker-set set.csv", folder);
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_THAT(other.err, HasSubstr("0 of the marker set's 5 labels"));
}

TEST(HandPoseCommand, MistakesInAMarkerSetAreNamed) {
  const std::string folder = temporary_folder();
  const auto message = [&](const std::string& text) {
    write_text(folder + "/set.csv", text);
    const ProgramRun run = run_palmar("hand pose " + kMarkers + " --marker-set set.csv", folder);
    EXPECT_EQ(run.exit_code, 3) << text;
    return run.err;
  };
  EXPECT_THAT(message("label,landmark\na,index_nial\n"), HasSubstr("did you mean index_nail?"));
  EXPECT_THAT(message("label,landmrk\na,index_nail\n"), HasSubstr("did you mean landmark?"));
  EXPECT_THAT(message("label,landmark\na,index_nail\na,ring_nail\n"), HasSubstr("set.csv:3"));
  EXPECT_THAT(message("label,landmark,vertex\na,index_nail,4\n"), HasSubstr("one is needed"));
  EXPECT_THAT(message("label,vertex\na,99999999\n"), HasSubstr("99999999"));
  EXPECT_THAT(message("label,x_mm,y_mm,z_mm\na,0,0,500\n"), HasSubstr("mm from the skin"));
  EXPECT_THAT(message("label,part,x_mm,y_mm,z_mm\na,plam,0,50,0\n"), HasSubstr("palm"));
  EXPECT_THAT(message("label,landmark\n"), HasSubstr("no markers"));
}

TEST(HandPoseCommand, RefusesWhatDoesNotFitTogether) {
  const std::string folder = temporary_folder();
  const auto fails = [&](const std::string& arguments, int code, const std::string& text) {
    const ProgramRun run = run_palmar("hand pose " + arguments, folder);
    EXPECT_EQ(run.exit_code, code) << arguments << run.err;
    EXPECT_THAT(run.err, HasSubstr(text)) << arguments;
  };
  fails("--posture fist --mesh a.ply", 2, "exclude each other");
  fails("--marker-set dorsal", 2, "--marker-set needs --markers");
  fails("--mesh missing.ply", 3, "missing.ply");
  fails(kMarkers + " --frame 9", 2, "has no frame 9; it has 1 to 5");
  fails(kMarkers + " --frame first", 2, "a number or all");
  fails(kMarkers + " --out a.png", 2, "--frame picks one");
  fails(kMarkers + " --unit m", 3, "is the unit right?");
  ASSERT_EQ(run_palmar("hand mirror template --out left.hand.glb", folder).exit_code, 0);
  fails("left.hand.glb " + kMarkers + " --frame 5", 3, "hand mirror");
}

TEST(HandPoseCommand, AMeshGivesItsPostureBack) {
  const std::string folder = temporary_folder();
  ASSERT_EQ(run_palmar("hand pose --posture cylinder_grip --out scan.stl", folder).exit_code, 0);
  const ProgramRun run = run_palmar("hand pose --mesh scan.stl --unit mm --json", folder);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json found = Json::parse(run.out);
  EXPECT_LT(found.at("distance_mm").at("median").get<double>(), 0.1);
  EXPECT_GT(found.at("partner_share").get<double>(), 0.98);
  EXPECT_NEAR(found.at("posture").at("middle_pip_flexion_deg").get<double>(), 52, 1);
  EXPECT_THAT(run.err, HasSubstr("has a partner on the mesh"));
}

TEST(GraspEvaluateCommand, TheGraspOfAssessGivesTheContactOfAssess) {
  const std::string folder = temporary_folder();
  ASSERT_EQ(run_palmar("product make cylinder --diameter-mm 45 --out c.stl", folder).exit_code, 0);
  const ProgramRun assessed =
      run_palmar("assess c.stl --unit mm --json --no-pictures --no-error-band", folder);
  ASSERT_EQ(assessed.exit_code, 0) << assessed.err;
  write_text(folder + "/a.json", assessed.out);
  const ProgramRun again =
      run_palmar("grasp evaluate c.stl --unit mm --grasp a.json --no-error-band --json", folder);
  ASSERT_EQ(again.exit_code, 0) << again.err;
  const Json a = Json::parse(assessed.out).at("assessments")[0];
  const Json b = Json::parse(again.out).at("assessments")[0];
  for (const char* key : {"force_n", "contact_area_mm2", "peak_pressure_mpa"}) {
    EXPECT_NEAR(b.at("contact").at(key).get<double>(), a.at("contact").at(key).get<double>(),
                1e-6 * a.at("contact").at(key).get<double>())
        << key;
  }
  EXPECT_EQ(b.at("grasp").at("status"), "held");
  EXPECT_EQ(b.at("grasp").at("segments")[3].at("stopped_by"), "given");
}

TEST(GraspEvaluateCommand, PlacementComesFromTheFileTheUserOrTheRecording) {
  const std::string folder = temporary_folder();
  ASSERT_EQ(run_palmar("product make cylinder --diameter-mm 45 --out c.stl", folder).exit_code, 0);
  ASSERT_EQ(run_palmar("grasp close c.stl --unit mm --out g.json", folder).exit_code, 0);
  Json grasp = Json::parse(read_text(folder + "/g.json"));
  const Json placement = grasp.at("product_from_hand");
  const std::string common = "--unit mm --no-error-band --json ";
  const auto force = [&](const std::string& arguments) {
    const ProgramRun run = run_palmar("grasp evaluate c.stl " + common + arguments, folder);
    EXPECT_EQ(run.exit_code, 0) << arguments << run.err;
    return Json::parse(run.out).at("assessments")[0].at("contact").at("force_n").get<double>();
  };
  const double whole = force("--grasp g.json");
  EXPECT_GT(whole, 10);
  grasp.erase("product_from_hand");
  write_text(folder + "/p.json", grasp.dump());
  const ProgramRun without = run_palmar("grasp evaluate c.stl --unit mm --posture p.json", folder);
  EXPECT_EQ(without.exit_code, 2);
  EXPECT_THAT(without.err, HasSubstr("--placement"));
  std::ostringstream numbers;
  numbers.precision(17);
  const Json& t = placement.at("translation_mm");
  const Json& q = placement.at("quaternion_wxyz");
  numbers << t[0].get<double>() << ',' << t[1].get<double>() << ',' << t[2].get<double>();
  for (const Json& one : q) numbers << ',' << one.get<double>();
  EXPECT_NEAR(force("--posture p.json --placement=" + numbers.str()), whole, 1e-6 * whole);
  // The recording's frame is the product's, shifted by 100 mm.
  Json moved = placement;
  moved["translation_mm"][0] = t[0].get<double>() + 100;
  grasp["measured_from_hand"] = moved;
  write_text(folder + "/m.json", grasp.dump());
  EXPECT_NEAR(force("--posture m.json --measured-from-product=100,0,0,1,0,0,0"), whole,
              1e-6 * whole);
}

TEST(GraspEvaluateCommand, APlacementFarOffSaysSo) {
  const std::string folder = temporary_folder();
  ASSERT_EQ(run_palmar("product make cylinder --diameter-mm 45 --out c.stl", folder).exit_code, 0);
  write_text(folder + "/p.json", R"({"index_pip_flexion_deg": 20})");
  const ProgramRun far = run_palmar(
      "grasp evaluate c.stl --unit mm --posture p.json --placement=900,0,0,1,0,0,0 --json", folder);
  ASSERT_EQ(far.exit_code, 0) << far.err;
  const Json one = Json::parse(far.out).at("assessments")[0];
  EXPECT_EQ(one.at("grasp").at("status"), "not_graspable");
  EXPECT_THAT(one.at("grasp").at("message").get<std::string>(), HasSubstr("mm away"));
  EXPECT_EQ(one.at("contact").at("status"), "no_contact");
  const auto message = [&](const std::string& arguments) {
    const ProgramRun run = run_palmar("grasp evaluate c.stl --unit mm " + arguments, folder);
    EXPECT_EQ(run.exit_code, 2) << arguments;
    return run.err;
  };
  EXPECT_THAT(message("--posture p.json --placement=1,2,3"), HasSubstr("seven are needed"));
  EXPECT_THAT(message("--posture p.json --placement=0,0,0,2,0,0,0"), HasSubstr("has length 2"));
  EXPECT_THAT(message("--posture p.json --grasp p.json"), HasSubstr("not both"));
  EXPECT_THAT(message(""), HasSubstr("is needed"));
}

}  // namespace
}  // namespace palmar::testing
