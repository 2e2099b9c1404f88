// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/mesh/section.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::geometry {
namespace {

TEST(PlaneSection, OfAPrismIsItsPolygon) {
  const int n = 48;
  const TriangleMesh prism = make_cylinder({.radius = 10.0, .length = 100.0, .segments = n});

  const auto curves = plane_section(prism, {0.0, 0.0, 13.0}, Vec3::UnitZ());

  ASSERT_EQ(curves.size(), 1u);
  EXPECT_TRUE(curves[0].is_closed);
  // Diagonals of the prism's sides add corners that lie on its edges or sides.
  EXPECT_NEAR(curve_length(curves[0]), 2.0 * n * 10.0 * std::sin(std::numbers::pi / n),
              1e-9);  // mm, exact
  EXPECT_NEAR(girth(curves[0].point, Vec3::UnitZ()), curve_length(curves[0]), 1e-9);
  EXPECT_NEAR(extent(curves[0].point, Vec3::UnitX()), 20.0, 1e-9);
  EXPECT_NEAR((curve_centre(curves[0]) - Vec3(0.0, 0.0, 13.0)).norm(), 0.0, 1e-9);
}

TEST(PlaneSection, RunsCounterClockwiseAboutTheNormal) {
  const TriangleMesh box = make_box({4.0, 6.0, 8.0});
  for (const Vec3& normal : {Vec3(Vec3::UnitZ()), Vec3(-Vec3::UnitZ())}) {
    const auto curves = plane_section(box, Vec3::Zero(), normal);
    ASSERT_EQ(curves.size(), 1u);
    double area = 0.0;
    const auto& p = curves[0].point;
    for (std::size_t i = 0; i < p.size(); ++i) {
      area += 0.5 * normal.dot(p[i].cross(p[(i + 1) % p.size()]));
    }
    EXPECT_NEAR(area, 24.0, 1e-12);  // mm^2
  }
}

TEST(PlaneSection, ObliqueThroughACylinderIsAnEllipse) {
  const TriangleMesh cylinder = make_cylinder({.radius = 10.0, .length = 100.0, .segments = 720});
  const double tilt = std::numbers::pi / 6.0;
  const Vec3 normal(std::sin(tilt), 0.0, std::cos(tilt));

  const auto curves = plane_section(cylinder, Vec3::Zero(), normal);

  ASSERT_EQ(curves.size(), 1u);
  const double a = 10.0 / std::cos(tilt), b = 10.0;
  // Perimeter by the complete elliptic integral of the second kind.
  const double perimeter = 4.0 * a * std::comp_ellint_2(std::sqrt(1.0 - b * b / (a * a)));
  EXPECT_NEAR(curve_length(curves[0]), perimeter, 1e-3);  // mm; 720 sides
  EXPECT_NEAR(extent(curves[0].point, Vec3::UnitY()), 2.0 * b, 1e-9);
}

TEST(PlaneSection, OfATorusAcrossItsRingIsTwoCurves) {
  const TriangleMesh torus = make_torus(30.0, 8.0, 96, 48);
  Vec3 across = Vec3::UnitX();
  if (extent(torus.vertices, Vec3::UnitX()) < 70.0) across = Vec3::UnitZ();
  const auto curves = plane_section(torus, Vec3(0.013, 0.017, 0.019), across);
  ASSERT_EQ(curves.size(), 2u);
  for (const SectionCurve& c : curves)
    EXPECT_NEAR(curve_length(c), 2.0 * std::numbers::pi * 8.0, 0.1);
}

TEST(PlaneSection, ThroughVerticesAndEdgesStaysClosed) {
  // The plane z = 0 holds vertices of the divided box.
  const TriangleMesh box = make_box({4.0, 4.0, 4.0}, 4);
  const auto curves = plane_section(box, Vec3::Zero(), Vec3::UnitZ());
  ASSERT_EQ(curves.size(), 1u);
  EXPECT_TRUE(curves[0].is_closed);
  EXPECT_NEAR(curve_length(curves[0]), 16.0, 1e-12);
}

TEST(PlaneSection, OfAnOpenSheetIsOpen) {
  const TriangleMesh sheet = make_grid_patch(5, 5, 2.0);
  const Vec3 inside = sheet.vertices[12] + Vec3(0.3, 0.0, 0.0);
  const auto curves = plane_section(sheet, inside, Vec3::UnitX());
  ASSERT_EQ(curves.size(), 1u);
  EXPECT_FALSE(curves[0].is_closed);
  EXPECT_NEAR(curve_length(curves[0]), extent(sheet.vertices, Vec3::UnitY()), 1e-12);
}

TEST(PlaneSection, MissingTheMeshIsEmpty) {
  EXPECT_TRUE(plane_section(make_box({1.0, 1.0, 1.0}), {0, 0, 9.0}, Vec3::UnitZ()).empty());
  EXPECT_TRUE(plane_section({}, Vec3::Zero(), Vec3::UnitZ()).empty());
}

TEST(PlaneSection, RefusesANormalThatIsNotOfUnitLength) {
  try {
    plane_section(make_box({1.0, 1.0, 1.0}), Vec3::Zero(), Vec3(0.0, 0.0, 2.0));
    FAIL() << "no error was thrown";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("length 2.0"));
  }
}

TEST(Girth, SpansHollows) {
  // An L of six corners: the tape cuts across the notch.
  const std::vector<Vec3> l{{0, 0, 0}, {4, 0, 0}, {4, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};
  EXPECT_NEAR(girth(l, Vec3::UnitZ()), 4.0 + 1.0 + std::sqrt(9.0 + 4.0) + 1.0 + 3.0, 1e-12);
}

TEST(Girth, OfFewPoints) {
  EXPECT_EQ(girth({}, Vec3::UnitZ()), 0.0);
  EXPECT_EQ(girth({{1, 2, 3}}, Vec3::UnitZ()), 0.0);
  EXPECT_NEAR(girth({{0, 0, 0}, {3, 0, 0}}, Vec3::UnitZ()), 6.0, 1e-12);  // there and back
}

}  // namespace
}  // namespace palmar::geometry
