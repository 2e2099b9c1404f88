// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/dimensions/tape_measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/geometry/rigid3.h"

namespace palmar::hand {
namespace {

constexpr double kHalfTurn = std::numbers::pi;

/// r(angle) in the plane z = 0.
geometry::SectionCurve curve_of(const std::function<double(double)>& radius, int count = 2000) {
  geometry::SectionCurve curve;
  curve.is_closed = true;
  for (int k = 0; k < count; ++k) {
    const double t = 2.0 * kHalfTurn * k / count;
    curve.point.push_back(radius(t) * Vec3(std::cos(t), std::sin(t), 0.0));
  }
  return curve;
}

geometry::SectionCurve ellipse(double a, double b) {
  return curve_of([=](double t) { return a * b / std::hypot(b * std::cos(t), a * std::sin(t)); });
}

/// Perimeter: 4 a E(sqrt(1 - b^2 / a^2)), a >= b.
double perimeter(double a, double b) {
  return 4.0 * a * std::comp_ellint_2(std::sqrt(1.0 - b * b / (a * a)));
}

TEST(TautLength, IsHalfAnEllipseOnEitherSide) {
  const geometry::SectionCurve curve = ellipse(9.0, 7.0);
  const Vec3 a(-9.0, 0.0, 0.0), b(9.0, 0.0, 0.0);
  const double half = 0.5 * perimeter(9.0, 7.0);
  EXPECT_NEAR(taut_length(curve, a, b, Vec3::UnitY()), half, 1e-3);
  EXPECT_NEAR(taut_length(curve, a, b, -Vec3::UnitY()), half, 1e-3);
  EXPECT_NEAR(taut_length(curve, b, a, Vec3::UnitY()), half, 1e-3);
}

TEST(TautLength, BeginsAndEndsOnThePartItself) {
  // A quarter of a circle of radius 10 as an arc of less than half of it: both ends on its top.
  const geometry::SectionCurve curve = curve_of([](double) { return 10.0; });
  const double s = 10.0 * std::sqrt(0.5);
  EXPECT_NEAR(taut_length(curve, {-s, s, 0.0}, {s, s, 0.0}, Vec3::UnitY()), 5.0 * kHalfTurn, 1e-3);
  EXPECT_EQ(taut_length(curve, {-s, s, 0.0}, {-s, s, 0.0}, Vec3::UnitY()), 0.0);
}

TEST(TautLength, SpansAHollowStraight) {
  // A block of 40 x 10 mm with a notch of 6 mm in its upper side.
  geometry::SectionCurve curve;
  curve.is_closed = true;
  curve.point = {{-20, -5, 0}, {20, -5, 0}, {20, 5, 0}, {5, 5, 0},
                 {0, -1, 0},   {-5, 5, 0},  {-20, 5, 0}};
  EXPECT_NEAR(taut_length(curve, {-20, 5, 0}, {20, 5, 0}, Vec3::UnitY()), 40.0, 1e-12);
  // From the bottom of the notch the tape is held in it, then lies on its edge.
  EXPECT_NEAR(taut_length(curve, {0, -1, 0}, {20, 5, 0}, Vec3::UnitY()),
              std::hypot(5.0, 6.0) + 15.0, 1e-9);
}

TEST(TautLength, HardlyFeelsRoughSkin) {
  // Waves of 0.15 mm, 3 mm long: the skin's own line is 2.4 % longer, the tape lies on the crests.
  const double r = 8.0, wave = 0.15;
  const geometry::SectionCurve rough =
      curve_of([=](double t) { return r + wave * std::cos(17.0 * t + 0.3); }, 6000);
  EXPECT_GT(0.5 * geometry::curve_length(rough), 1.02 * kHalfTurn * r);
  const double tape = taut_length(rough, {-r, 0, 0}, {r, 0, 0}, Vec3::UnitY());
  EXPECT_LT(tape, kHalfTurn * (r + wave));
  EXPECT_GT(tape, kHalfTurn * (r - wave));
}

TEST(TautLength, IsTheSameWhereverItLiesAndHoweverItIsCut) {
  // Sections of an ellipsoid cut into triangles of two sizes, anywhere in space: what is left is
  // what the chords of an arc lack, e^2 / (24 r^2) of it.
  const auto measured = [](int levels, const geometry::Rigid3& motion) {
    geometry::TriangleMesh mesh = geometry::make_icosphere(1.0, levels);
    for (Vec3& v : mesh.vertices) v = motion * Vec3(9.0 * v.x(), 30.0 * v.y(), 7.0 * v.z());
    const auto curves =
        geometry::plane_section(mesh, motion * Vec3::Zero(), motion.rotation * Vec3::UnitX());
    return taut_length(curves.at(0), motion * Vec3(0, -30, 0), motion * Vec3(0, 30, 0),
                       motion.rotation * Vec3::UnitZ());
  };
  const geometry::Rigid3 away{Quat(0.3, -0.5, 0.2, 0.78).normalized(), Vec3(400.0, -250.0, 90.0)};
  const double half = 0.5 * perimeter(30.0, 7.0);
  EXPECT_NEAR(measured(5, {}), half, 0.05);
  EXPECT_NEAR(measured(6, {}), half, 0.05);
  EXPECT_NEAR(measured(5, away), measured(5, {}), 1e-9);
}

TEST(TautLength, OfNothingIsNothing) {
  EXPECT_EQ(taut_length({}, Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY()), 0.0);
}

}  // namespace
}  // namespace palmar::hand
