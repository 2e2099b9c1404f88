// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/product_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/workflow/hand/workflow_test_hand.h"
#include "palmar/workflow/press.h"

namespace palmar::workflow {
namespace {

using testing::HasSubstr;
using workflow_test::handle;
using workflow_test::TemporaryFolder;

TEST(ConvertProduct, CentimetresBecomeMillimetres) {
  const TemporaryFolder folder;
  geometry::TriangleMesh mesh = handle(40.0).mesh;
  for (Vec3& vertex : mesh.vertices) vertex /= 10.0;
  formats::write_mesh(folder / "cm.obj", mesh);
  std::string notes;
  convert_product({.file = (folder / "cm.obj").string(),
                   .out = (folder / "mm.stl").string(),
                   .reading = {.unit = geometry::LengthUnit::kCentimetre},
                   .note = [&](const std::string& text) { notes += text; }});
  const double volume = geometry::signed_volume(formats::read_mesh(folder / "mm.stl").mesh);
  const double cylinder = std::numbers::pi * 20.0 * 20.0 * 140.0;
  EXPECT_NEAR(volume, cylinder, 0.02 * cylinder);  // mm^3; the mesh lies inside the cylinder
}

TEST(ConvertProduct, MeshHasNoSurfacesForStep) {
  try {
    convert_product({.file = "mug.stl", .out = "mug.step"});
    FAIL() << "a mesh became STEP";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("mug.stl: a mesh has no surfaces"));
  }
}

TEST(InspectProduct, FileIsJudgedAsItIsBeforeAnyRepair) {
  const TemporaryFolder folder;
  geometry::TriangleMesh mesh = handle(40.0).mesh;
  mesh.triangles.pop_back();
  formats::write_mesh(folder / "open.obj", mesh);
  const InspectOutcome outcome =
      inspect_product({.file = (folder / "open.obj").string(),
                       .reading = {.unit = geometry::LengthUnit::kMillimetre}});
  EXPECT_FALSE(outcome.check.is_closed);
  EXPECT_EQ(outcome.check.boundary_edges, 3);
  EXPECT_FALSE(outcome.cad);
}

TEST(RepairProduct, MissingTriangleIsPutBackAndTheFileStaysAsItWas) {
  const TemporaryFolder folder;
  geometry::TriangleMesh mesh = handle(40.0).mesh;
  const double whole = geometry::signed_volume(mesh);
  mesh.triangles.pop_back();
  const std::string file = (folder / "open.obj").string();
  formats::write_mesh(file, mesh);
  const auto written = std::filesystem::last_write_time(file);
  const RepairOutcome outcome = repair_product({.file = file,
                                                .unit = geometry::LengthUnit::kMillimetre,
                                                .out = (folder / "closed.obj").string(),
                                                .options = {}});
  EXPECT_FALSE(outcome.before.is_closed);
  EXPECT_TRUE(outcome.after.is_closed);
  EXPECT_NEAR(outcome.after.volume, whole, 1e-6 * whole);  // mm^3; digits of the file
  EXPECT_EQ(std::filesystem::last_write_time(file), written);
}

TEST(RunPress, RigidSphereOnTissueWithoutEndObeysHertz) {
  // Hertz 1882 for incompressible tissue: F = 16 / 3 G sqrt(R) d^1.5.
  PressRequest request;
  request.test.indenter.radius = 20.0;
  request.test.shear_modulus = 0.01;
  request.test.depths = {1.0};
  const PressOutcome outcome = run_press(request);
  ASSERT_EQ(outcome.steps.size(), 1U);
  const double hertz = 16.0 / 3.0 * 0.01 * std::sqrt(20.0);
  EXPECT_NEAR(outcome.steps.front().force, hertz, 0.02 * hertz);  // N; the lattice
  request.out = "curve.png";
  try {
    request.check();
    FAIL() << "a curve can't be written as PNG";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("setting \"out\": \"curve.png\" ends with none of .json, .csv, .svg"));
  }
}

}  // namespace
}  // namespace palmar::workflow
