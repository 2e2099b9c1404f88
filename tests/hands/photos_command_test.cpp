// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "run_program.h"

// `palmar photos` and `palmar phantom photos` on a few small pictures of a box, whose edges are
// known. Skipped where Palmar was
// built without OpenCV. How near the surface comes to the truth with pictures of a useful size is
// reported in docs/method/photos.md.

namespace palmar::testing {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

bool has_photographs() {
  return run_palmar("photos board --out b.svg", temporary_folder()).exit_code != 6;
}

struct Point {
  double x, y, z;
};

/// Vertices of a binary PLY as Palmar writes it: three doubles first.
std::vector<Point> vertices_of(const std::string& bytes) {
  const std::string end = "end_header\n", count = "element vertex ";
  const std::size_t begin = bytes.find(end) + end.size();
  std::size_t stride = 0;
  for (std::size_t at = 0; (at = bytes.find("property ", at)) < bytes.find("element face");) {
    stride += bytes.compare(at, 15, "property double") == 0 ? 8 : 1;
    at += 9;
  }
  std::vector<Point> points(std::stoul(bytes.substr(bytes.find(count) + count.size())));
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::memcpy(&points[i], bytes.data() + begin + i * stride, sizeof(Point));
  }
  return points;
}

/// Mean of a coordinate over the middle of a face.
double face_at(const std::vector<Point>& points, double Point::*along, double from, double to,
               const std::function<bool(const Point&)>& is_middle) {
  double sum = 0.0, count = 0.0;
  for (const Point& p : points) {
    if (p.*along < from || p.*along > to || !is_middle(p)) continue;
    sum += p.*along;
    count += 1.0;
  }
  return sum / count;
}

TEST(Photos, FromPhantomToMesh) {
  if (!has_photographs()) GTEST_SKIP() << "palmar-photo isn't built";
  const std::string folder = temporary_folder();
  const ProgramRun taken = run_palmar(
      "phantom photos --seed 3 --block-mm 60,40,90 --cameras 4 --positions 3 --step-deg 30 "
      "--width-px 324 --height-px "
      "432 --calibration 3 --jpeg 95 --out p",
      folder);
  ASSERT_EQ(taken.exit_code, 0) << taken.err;
  const std::string make =
      "photos mesh p/photos --lenses p/calibration --pixel-mm 0.9 --no-motion --out hand.ply "
      "--json";
  const ProgramRun mesh = run_palmar(make, folder);
  ASSERT_EQ(mesh.exit_code, 0) << mesh.err;
  // Another run finds the mesh of the same photographs and leaves it.
  const std::string made = read_text(folder + "/hand.ply");
  const ProgramRun again = run_palmar(make, folder);
  EXPECT_EQ(again.out, mesh.out);
  EXPECT_THAT(again.err, HasSubstr("is there already"));
  EXPECT_EQ(read_text(folder + "/hand.ply"), made);
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
  // The box, which stands turned by 25 degrees; two pixels is what may be asked.
  std::vector<Point> points = vertices_of(made);
  const double c = std::cos(-25.0 * std::numbers::pi / 180.0);
  const double s = std::sin(-25.0 * std::numbers::pi / 180.0);
  for (Point& p : points) p = {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
  const auto of_x = [](const Point& p) { return std::abs(p.y) < 13 && p.z > 15 && p.z < 75; };
  const auto of_y = [](const Point& p) { return std::abs(p.x) < 20 && p.z > 15 && p.z < 75; };
  const auto of_z = [](const Point& p) { return std::abs(p.x) < 20 && std::abs(p.y) < 13; };
  EXPECT_NEAR(face_at(points, &Point::x, 20, 40, of_x) - face_at(points, &Point::x, -40, -20, of_x),
              60.0, 1.8);
  EXPECT_NEAR(face_at(points, &Point::y, 12, 30, of_y) - face_at(points, &Point::y, -30, -12, of_y),
              40.0, 1.8);
  EXPECT_NEAR(face_at(points, &Point::z, 80, 100, of_z), 90.0, 1.8);
  EXPECT_THAT(made.substr(0, 600), HasSubstr("property uchar measured"));

  // And with one that is no photograph.
  std::ofstream(folder + "/p/photos/p00_c9.jpg") << "hello";
  const ProgramRun wrong = run_palmar("photos mesh p/photos --out hand.ply", folder);
  EXPECT_EQ(wrong.exit_code, 3);
  EXPECT_THAT(wrong.err, HasSubstr("p00_c9.jpg"));
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
  run = run_palmar("hand from-photos empty --out a.hand.glb", folder);
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, HasSubstr("no photograph"));
  run = run_palmar("hand from-photos empty other --out a.hand.glb", folder);
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, HasSubstr("other"));
  fs::create_directory(folder + "/other");
  run = run_palmar("hand from-photos empty other/ --out a.hand.glb", folder);
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("doesn't give the posture"));
  for (const char* const name : {"p0_c1.png", "p1_c1.png", "p2_c1.png", "extra.png"}) {
    std::ofstream(folder + "/other/" + name) << "hello";
  }
  run = run_palmar("photos mesh other --out hand.ply", folder);
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, HasSubstr("the names of 3 photographs give position and camera (as "
                                 "p3_c2.jpg does), that of extra.png doesn't"));
  run = run_palmar("photos board --squares 10 --out board.svg", folder);
  if (run.exit_code != 6) {
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(run.err, HasSubstr("odd number"));
  }
}

}  // namespace
}  // namespace palmar::testing
