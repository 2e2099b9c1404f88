// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "run_program.h"

// `palmar photos` and `palmar phantom photos` on a few small pictures. Skipped where Palmar was
// built without OpenCV. How near the surface comes to the truth with pictures of a useful size is
// told in docs/method/photos.md.

namespace palmar::testing {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

bool has_photographs() {
  return run_palmar("photos board --out b.svg", temporary_folder()).exit_code != 6;
}

TEST(Photos, FromPhantomToMesh) {
  if (!has_photographs()) GTEST_SKIP() << "palmar-photo isn't built";
  const std::string folder = temporary_folder();
  const ProgramRun taken = run_palmar(
      "phantom photos --seed 3 --cameras 4 --positions 3 --step-deg 30 --width-px 324 --height-px "
      "432 --calibration 3 --out p",
      folder);
  ASSERT_EQ(taken.exit_code, 0) << taken.err;
  const ProgramRun lenses = run_palmar("photos calibrate p/calibration --out lenses.json", folder);
  ASSERT_EQ(lenses.exit_code, 0) << lenses.err;
  const ProgramRun mesh = run_palmar(
      "photos mesh p/photos --lenses lenses.json --pixel-mm 0.9 --no-motion --out hand.ply --json",
      folder);
  ASSERT_EQ(mesh.exit_code, 0) << mesh.err;
  const auto report = nlohmann::json::parse(mesh.out);
  EXPECT_GT(report.at("measured_share").get<double>(), 0.5);
  // Cameras against the truth: a pixel of these pictures covers 0.9 mm.
  const auto truth = nlohmann::json::parse(read_text(folder + "/p/truth/cameras.json"));
  for (const auto& one : report.at("photographs")) {
    ASSERT_TRUE(one.at("is_used").get<bool>());
    EXPECT_LT(one.at("board_residual_px").get<double>(), 1.0);
    for (const auto& known : truth.at("photographs")) {
      if (known.at("file") != "photos/" + one.at("file").get<std::string>()) continue;
      const auto& pose = known.at("camera_from_board").at("translation_mm");
      for (int a = 0; a < 3; ++a) {
        EXPECT_NEAR(one.at("translation_mm").at(a).get<double>(), pose.at(a).get<double>(), 5.0);
      }
    }
  }
  EXPECT_THAT(read_text(folder + "/hand.ply").substr(0, 600), HasSubstr("property uchar measured"));

  // And with one that is no photograph.
  std::ofstream(folder + "/p/photos/p00_c9.png") << "hello";
  const ProgramRun wrong = run_palmar("photos mesh p/photos --out hand.ply", folder);
  EXPECT_EQ(wrong.exit_code, 3);
  EXPECT_THAT(wrong.err, HasSubstr("p00_c9.png"));
}

TEST(Photos, RefusesWhatIsNone) {
  const std::string folder = temporary_folder();
  fs::create_directory(folder + "/empty");
  ProgramRun run = run_palmar("photos mesh empty --out hand.ply", folder);
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, HasSubstr("no photograph"));
  run = run_palmar("photos mesh empty --out hand.stl", folder);
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("hand.stl"));
  run = run_palmar("photos board --squares 10 --out board.svg", folder);
  if (run.exit_code != 6) {
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(run.err, HasSubstr("odd number"));
  }
}

}  // namespace
}  // namespace palmar::testing
