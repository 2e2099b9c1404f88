// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "run_program.h"

// `palmar phantom mri`, `palmar mri series`, `palmar mri info` as a user runs them.

namespace palmar::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Json = nlohmann::json;

/// Two scans of one person, coarse and few slices: made once.
const std::string& scans() {
  static const std::string folder = [] {
    const std::string made = temporary_folder();
    const ProgramRun run = run_palmar(
        "phantom mri --seed 4 --side left --pixel-mm 2 --slice-mm 4 --slices 30 --oblique-deg 10 "
        "--posture grasp,reference --out p",
        made);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("truth: p/truth/subject.json"));
    return made;
  }();
  return folder;
}

TEST(PhantomMri, LeavesOneSeriesPerPostureAndTheTruth) {
  const std::string root = scans() + "/p";
  const Json truth = Json::parse(read_text(root + "/truth/subject.json"));
  EXPECT_EQ(truth.at("side"), "left");
  EXPECT_EQ(truth.at("seed"), 4);
  EXPECT_GT(truth.at("dimensions").at("hand_length_mm").get<double>(), 150.0);
  EXPECT_EQ(truth.at("postures").size(), 2U);
  const Json& grasp = truth.at("postures").at("grasp");
  EXPECT_EQ(grasp.at("series"), "mri/grasp");
  EXPECT_GT(grasp.at("angles_deg").at("index_pip_flexion").get<double>(), 10.0);
  EXPECT_TRUE(grasp.at("patient_from_reference").contains("thumb_metacarpal"));
  EXPECT_EQ(truth.at("postures").at("reference").at("markers_mm").size(), 12U);
  EXPECT_TRUE(fs::exists(root + "/truth/grasp/skin.ply"));
  EXPECT_TRUE(fs::exists(root + "/truth/reference/bones/thumb_metacarpal.ply"));
  // An axis is a unit vector.
  for (const Json& axis : truth.at("axes_at_reference")) {
    double square = 0.0;
    for (const Json& part : axis.at("axis")) square += part.get<double>() * part.get<double>();
    EXPECT_NEAR(square, 1.0, 1e-9) << axis.at("joint");
  }
}

TEST(MriSeries, ListsWhatIsThere) {
  const ProgramRun run = run_palmar("mri series p --json", scans());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json series = Json::parse(run.out).at("series");
  ASSERT_EQ(series.size(), 2U);
  EXPECT_EQ(series.at(0).at("posture"), "reference");
  EXPECT_EQ(series.at(0).at("laterality"), "L");
  EXPECT_EQ(series.at(1).at("description"), "grasp");
  EXPECT_EQ(series.at(1).at("slices"), 30);
  EXPECT_EQ(series.at(1).at("refusal"), "");
  EXPECT_THAT(run_palmar("mri series p", scans()).out, HasSubstr("30 of 100 x"));
}

TEST(MriInfo, ReportsPlaceAndIntensities) {
  const ProgramRun run = run_palmar("mri info p --description grasp --json", scans());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json info = Json::parse(run.out);
  EXPECT_NEAR(info.at("spacing_mm").at(2).get<double>(), 4.0, 1e-9);
  EXPECT_GT(info.at("noise_deviation").get<double>(), 1.0);
  const ProgramRun both = run_palmar("mri info p", scans());
  EXPECT_EQ(both.exit_code, 3);
  EXPECT_THAT(both.err, HasSubstr("several series; choose one"));
  EXPECT_THAT(run_palmar("mri info p --series 8", scans()).out, HasSubstr("side          L"));
}

TEST(MriSeries, DamageIsNamed) {
  const std::string folder = temporary_folder();
  fs::copy(scans() + "/p/mri/reference", folder + "/s");
  fs::remove(folder + "/s/slice-0012.dcm");
  const ProgramRun missing = run_palmar("mri info s", folder);
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_THAT(missing.err, HasSubstr("1 slice is missing"));
  EXPECT_THAT(missing.err, HasSubstr("slice-0011.dcm"));
  EXPECT_THAT(run_palmar("mri series s", folder).out, HasSubstr("no volume: 1 slice is missing"));
  fs::create_directories(folder + "/empty");
  const ProgramRun empty = run_palmar("mri series empty", folder);
  EXPECT_EQ(empty.exit_code, 3);
  EXPECT_THAT(empty.err, HasSubstr("empty: is empty; DICOM files are required"));
}

TEST(PhantomMri, WrongUseIsNamed) {
  const ProgramRun posture = run_palmar("phantom mri --out x --posture refrence", ".");
  EXPECT_EQ(posture.exit_code, 2);
  EXPECT_THAT(posture.err, HasSubstr("did you mean reference?"));
  const ProgramRun side = run_palmar("phantom mri --out x --side middle", ".");
  EXPECT_EQ(side.exit_code, 2);
  EXPECT_THAT(side.err, HasSubstr("neither right nor left"));
}

}  // namespace
}  // namespace palmar::testing
