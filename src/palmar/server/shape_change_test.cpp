// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/server/shape_change.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/records/product/made_product.h"

namespace palmar {
namespace {

TEST(ShapeChange, ThinnerCylinderLiesInsideByTheDifferenceOfRadii) {
  const Product original = make_solid({"cylinder", {{"diameter_mm", 40.0}, {"length_mm", 120.0}}});
  const Product thinner = make_solid({"cylinder", {{"diameter_mm", 36.0}, {"length_mm", 100.0}}});
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
  const Product ball = make_solid({"sphere", {{"diameter_mm", 60.0}}});
  for (const double moved : change_of(ball, ball.mesh)) EXPECT_NEAR(moved, 0.0, 1e-6);
}

TEST(ShapeChange, FramesAreOfTheFilesThatAreThere) {
  std::string name = (std::filesystem::temp_directory_path() / "palmar_shape_XXXXXX").string();
  const std::filesystem::path folder = mkdtemp(name.data());
  const Product ball = make_solid({"sphere", {{"diameter_mm", 60.0}}});
  write_mesh(folder / "ball.stl", ball.mesh);
  ShelvedProduct shelved;
  shelved.file_name = shelved.argument = "ball.stl";
  shelved.path = folder / "ball.stl";
  shelved.unit = LengthUnit::kMillimetre;
  const std::string before = shape_frame(shelved, ""), after = shape_frame(shelved, shelved.path);
  const std::size_t vertices = ball.mesh.vertices.size();
  EXPECT_EQ(before.substr(0, 4), "PLM1");
  EXPECT_EQ(after.size(), before.size() + 4 * vertices) << "a number per vertex more";
  EXPECT_THROW(shape_frame(shelved, folder / "none.stl"), InputError);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace palmar
