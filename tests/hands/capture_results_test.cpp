// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "run_program.h"

// Small cases from a picture to a result, held to limits against the truth of a synthetic person.
// Others stand elsewhere: from surfaces of bones to joints (from_mri_test), from scans
// (hand_from_scan_test), from one photograph (quick_command_test).

namespace palmar::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// Bones of a folder by the names of their files.
std::map<std::string, geometry::TriangleMesh> bones_in(const fs::path& folder) {
  std::map<std::string, geometry::TriangleMesh> bones;
  for (const auto& entry : fs::directory_iterator(folder)) {
    bones[entry.path().stem().string()] = formats::read_mesh(entry.path()).mesh;
  }
  return bones;
}

/// The first table of a TOML file with these words; "" if there is none.
std::string table_with(const std::string& toml, const std::string& words) {
  const std::size_t at = toml.find(words);
  if (at == std::string::npos) return {};
  const std::size_t begin = toml.rfind("[[", at), end = toml.find("[[", at);
  return toml.substr(begin, end - begin);
}

double mean_distance(const geometry::TriangleMesh& found, const geometry::TriangleMesh& truth) {
  const geometry::ClosestPointQuery query(truth);
  double sum = 0.0;
  for (const Vec3& v : found.vertices) sum += query.closest(v)->distance;
  return sum / static_cast<double>(found.vertices.size());
}

// Voxels of 1 x 1 x 1.2 mm, coarser than is advised.
TEST(CaptureResults, AnImageGivesEveryBoneItsNameAndPlace) {
  const std::string folder = temporary_folder();
  ProgramRun run = run_palmar(
      "phantom mri --seed 3 --posture reference --pixel-mm 1.0 --slice-mm 1.2 --slices 104 --out p",
      folder);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  run = run_palmar("mri surfaces p/mri/reference --out found", folder);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto truth = bones_in(fs::path(folder) / "p/truth/reference/bones");
  const auto found = bones_in(fs::path(folder) / "found/bones");
  // 19 long bones and eight carpals; forearm bones are cut by the image and may lack.
  int named = 0;
  double sum = 0.0;
  for (const auto& [name, mesh] : found) {
    if (name == "radius" || name == "ulna") continue;
    const auto known = truth.find(name);
    ASSERT_NE(known, truth.end()) << name;
    EXPECT_LT((geometry::centre_of_volume(mesh) - geometry::centre_of_volume(known->second)).norm(),
              2.0)
        << name;
    const double distance = mean_distance(mesh, known->second);
    EXPECT_LT(distance, 0.8) << name;  // mm
    sum += distance;
    ++named;
  }
  EXPECT_GE(named, 26);
  EXPECT_LT(sum / named, 0.45);  // mm; half a voxel
  const geometry::TriangleMesh skin = formats::read_mesh(fs::path(folder) / "found/skin.ply").mesh;
  const geometry::TriangleMesh true_skin =
      formats::read_mesh(fs::path(folder) / "p/truth/reference/skin.ply").mesh;
  std::vector<double> distances;
  const geometry::ClosestPointQuery query(true_skin);
  for (std::size_t v = 0; v < skin.vertices.size(); v += 7) {
    distances.push_back(query.closest(skin.vertices[v])->distance);
  }
  std::nth_element(distances.begin(), distances.begin() + distances.size() / 2, distances.end());
  EXPECT_LT(distances[distances.size() / 2], 0.4);  // mm, median; the image cuts the forearm

  // Somebody says what a bone is: the file that was written has its place.
  const std::string look = "hand from-mri found --series found=reference --look --out a.hand.glb";
  run = run_palmar(look, folder);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  std::string table = table_with(read_text(folder + "/a.mri/found.toml"), "name = \"capitate\"");
  table.replace(table.find("capitate"), 8, "hamate");
  write_text(folder + "/anna.toml", table);
  run = run_palmar(look + " --known anna.toml", folder);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string again = read_text(folder + "/a.mri/found.toml");
  EXPECT_EQ(table_with(again, "name = \"capitate\""), "");
  const std::string place = table.substr(table.find("at_mm"));
  EXPECT_THAT(table_with(again, "name = \"hamate\""), HasSubstr(place));
}

// 24 photographs of 0.4 megapixels of the reference posture, to the hand. Minutes.
TEST(CaptureResults, ThoroughPhotographsGiveAHand) {
  const std::string folder = temporary_folder();
  ProgramRun run = run_palmar(
      "phantom photos --seed 53 --cameras 4 --positions 6 --step-deg 15 --width-px 540 "
      "--height-px 720 --calibration 5 --out p",
      folder);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  run = run_palmar(
      "hand from-photos p/photos --posture p/photos=reference --lenses p/calibration --pixel-mm 1 "
      "--truth p/truth/subject.json --out a.hand.glb --work w",
      folder);
  if (run.exit_code == 6) GTEST_SKIP() << "palmar-photo isn't built";
  ASSERT_EQ(run.exit_code, 0) << run.err;
  // Means of the dimensions' errors by kind: those of Xie 2014, section 4.5.
  std::map<std::string, double> sum, count;
  std::istringstream rows(read_text(folder + "/w/truth_errors.csv"));
  for (std::string row; std::getline(rows, row);) {
    std::istringstream cells(row);
    std::string what, posture, segment, difference;
    std::getline(cells, what, ',');
    std::getline(cells, posture, ',');
    std::getline(cells, segment, ',');
    std::getline(cells, difference, ',');
    for (const char* kind : {"_length", "_width", "_thickness"}) {
      if (!what.ends_with(kind)) continue;
      sum[kind] += std::abs(std::stod(difference));
      count[kind] += 1.0;
    }
  }
  ASSERT_EQ(sum.size(), 3U);
  EXPECT_LT(sum["_length"] / count["_length"], 1.1);
  EXPECT_LT(sum["_width"] / count["_width"], 1.2);
  EXPECT_LT(sum["_thickness"] / count["_thickness"], 1.0);

  // Somebody says that a dot is none; the meshes are those that were made.
  std::string dot = table_with(read_text(folder + "/w/found.toml"), "mark = \"dot\"");
  const std::string place = dot.substr(dot.find("at_mm"));
  dot.replace(dot.find("name = \"\""), 9, "name = \"none\"");
  write_text(folder + "/anna.toml", dot);
  run = run_palmar(
      "hand from-photos p/photos --posture p/photos=reference --lenses p/calibration --pixel-mm 1 "
      "--known anna.toml --look --out b.hand.glb --work w",
      folder);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("whose mesh is there already"));
  EXPECT_EQ(table_with(read_text(folder + "/w/found.toml"), place), "");
}

}  // namespace
}  // namespace palmar::testing
