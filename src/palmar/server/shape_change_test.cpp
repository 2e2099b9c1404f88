// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/server/shape_change.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/records/product/made_product.h"

namespace palmar::server {
namespace {

TEST(ShapeChange, ThinnerCylinderLiesInsideByTheDifferenceOfRadii) {
  const product::Product original =
      records::make_solid({"cylinder", {{"diameter_mm", 40.0}, {"length_mm", 120.0}}});
  const product::Product thinner =
      records::make_solid({"cylinder", {{"diameter_mm", 36.0}, {"length_mm", 100.0}}});
  const std::vector<double> change = change_of(original, thinner.mesh);
  ASSERT_EQ(change.size(), thinner.mesh.vertices.size());
  for (std::size_t i = 0; i < change.size(); ++i) {
    const Vec3& at = thinner.mesh.vertices[i];
    const double radius = std::hypot(at.x(), at.y());
    if (radius < 17.9 || std::abs(at.z()) > 40.0) continue;  // rounded edges, ends
    EXPECT_NEAR(change[i], radius - 20.0, 0.05) << i;        // mm; the facets' chords
  }
}

TEST(ShapeChange, SameShapeDoesNotMove) {
  const product::Product ball = records::make_solid({"sphere", {{"diameter_mm", 60.0}}});
  for (const double moved : change_of(ball, ball.mesh)) EXPECT_NEAR(moved, 0.0, 1e-6);
}

/// The largest of the numbers that stand at the end of a footprint frame, one per vertex.
double most_in(const std::string& frame) {
  std::uint32_t vertices = 0;
  std::memcpy(&vertices, frame.data() + 16, 4);
  std::vector<float> values(vertices);
  std::memcpy(values.data(), frame.data() + frame.size() - 4 * vertices, 4 * vertices);
  return *std::max_element(values.begin(), values.end());
}

TEST(ShapeChange, RoundedEdgeLiesAsDeepAsItsRadiusSays) {
  std::string name = (std::filesystem::temp_directory_path() / "palmar_edge_XXXXXX").string();
  const std::filesystem::path folder = mkdtemp(name.data());
  const auto bar = [](double fillet) {
    return records::make_solid(
        {"prism",
         {{"width_mm", 40.0}, {"depth_mm", 30.0}, {"length_mm", 130.0}, {"fillet_mm", fillet}}});
  };
  formats::write_mesh(folder / "sharp.stl", bar(0.0).mesh);
  formats::write_mesh(folder / "round.stl", bar(6.0).mesh);
  ShelvedProduct sharp;
  sharp.file_name = sharp.argument = "sharp.stl";
  sharp.path = folder / "sharp.stl";
  sharp.unit = geometry::LengthUnit::kMillimetre;
  // The middle of the arc lies r (1 - cos 45 deg) under both faces.
  EXPECT_NEAR(most_in(shape_frame(sharp, folder / "round.stl")), 6.0 * (1.0 - std::sqrt(0.5)), 0.1);
  EXPECT_NEAR(most_in(shape_frame(sharp, folder / "sharp.stl")), 0.0, 1e-3);
  std::filesystem::remove_all(folder);
}

TEST(ShapeChange, FramesAreOfTheFilesThatAreThere) {
  std::string name = (std::filesystem::temp_directory_path() / "palmar_shape_XXXXXX").string();
  const std::filesystem::path folder = mkdtemp(name.data());
  const product::Product ball = records::make_solid({"sphere", {{"diameter_mm", 60.0}}});
  formats::write_mesh(folder / "ball.stl", ball.mesh);
  ShelvedProduct shelved;
  shelved.file_name = shelved.argument = "ball.stl";
  shelved.path = folder / "ball.stl";
  shelved.unit = geometry::LengthUnit::kMillimetre;
  const std::string before = shape_frame(shelved, ""), after = shape_frame(shelved, shelved.path);
  EXPECT_EQ(before.substr(0, 4), "PLM1");
  EXPECT_GE(after.size(), before.size() + 4 * ball.mesh.vertices.size());
  EXPECT_THROW(shape_frame(shelved, folder / "none.stl"), InputError);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace palmar::server
