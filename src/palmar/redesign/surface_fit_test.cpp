// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/surface_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "palmar/core/error.h"
#include "palmar/geometry/degrees.h"

namespace palmar::redesign {
namespace {

/// Points of a patch with normals, turned and shifted, with noise along the normals.
struct Patch {
  std::vector<Vec3> points, normals;
};

struct Frame {
  Quat turn = Quat(Eigen::AngleAxisd(0.7, Vec3(0.2, -0.5, 1.0).normalized()));
  Vec3 shift = Vec3(12.0, -40.0, 7.0);
};

/// `surface(u, v)` gives point and normal for u, v in [0, 1].
Patch sampled(const std::function<std::pair<Vec3, Vec3>(double, double)>& surface,
              double noise = 0.0, int n = 30) {
  Patch patch;
  std::mt19937 random(5);
  std::normal_distribution<double> bell(0.0, 1.0);
  const Frame frame;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const auto [x, normal] = surface((i + 0.5) / n, (j + 0.5) / n);
      const Vec3 moved = x + noise * bell(random) * normal;
      patch.points.emplace_back(frame.turn * moved + frame.shift);
      patch.normals.emplace_back(frame.turn * normal);
    }
  }
  return patch;
}

Patch cylinder(double radius, double angle, double length, double noise = 0.0) {
  return sampled(
      [=](double u, double v) {
        const double t = angle * (u - 0.5);
        const Vec3 normal(std::cos(t), std::sin(t), 0.0);
        return std::pair(Vec3(radius * normal + length * (v - 0.5) * Vec3::UnitZ()), normal);
      },
      noise);
}

Patch torus(double radius, double tube, double turn, double round, double noise = 0.0,
            double start = 0.0) {
  return sampled(
      [=](double u, double v) {
        const double a = turn * (u - 0.5), b = start + round * (v - 0.5);
        const Vec3 out(std::cos(a), std::sin(a), 0.0);
        const Vec3 normal = std::cos(b) * out + std::sin(b) * Vec3::UnitZ();
        return std::pair(Vec3(radius * out + tube * normal), normal);
      },
      noise);
}

void expect_axis(const SimpleSurface& surface, double tolerance) {
  const Frame frame;
  const Vec3 axis = frame.turn * Vec3::UnitZ();
  EXPECT_LT(surface.axis.cross(axis).norm(), tolerance) << surface.axis.transpose();
  // The axis goes through the frame's origin.
  const Vec3 way = frame.shift - surface.point;
  EXPECT_LT((way - way.dot(axis) * axis).norm(), 100.0 * tolerance);
}

TEST(FitSurface, FindsTheRadiusAndAxisOfACylinderFromASixthOfIt) {
  const Patch patch = cylinder(17.5, std::numbers::pi / 3.0, 40.0);
  for (const bool with_normals : {false, true}) {
    const SurfaceFit fit = fit_surface(product::FaceKind::kCylinder, patch.points,
                                       with_normals ? patch.normals : std::vector<Vec3>(), {});
    ASSERT_TRUE(fit.has_converged);
    EXPECT_NEAR(fit.surface.radius, 17.5, 1e-6);  // mm
    EXPECT_LT(fit.rms, 1e-8);
    expect_axis(fit.surface, 1e-7);
  }
}

TEST(FitSurface, FindsAShortWideCylinderWhoseAxisIsTheShortestExtent) {
  const SurfaceFit fit = fit_surface(product::FaceKind::kCylinder,
                                     cylinder(50.0, 2.0 * std::numbers::pi, 10.0).points, {});
  EXPECT_NEAR(fit.surface.radius, 50.0, 1e-6);
  EXPECT_LT(fit.rms, 1e-8);
}

TEST(FitSurface, FindsASphereFromASmallCap) {
  const Patch patch = sampled([](double u, double v) {
    const double a = 2.0 * std::numbers::pi * u, b = 0.3 * std::sqrt(v);
    const Vec3 normal(std::sin(b) * std::cos(a), std::sin(b) * std::sin(a), std::cos(b));
    return std::pair(Vec3(25.0 * normal), normal);
  });
  const SurfaceFit fit = fit_surface(product::FaceKind::kSphere, patch.points, patch.normals);
  ASSERT_TRUE(fit.has_converged);
  EXPECT_NEAR(fit.surface.radius, 25.0, 1e-6);
  EXPECT_LT((fit.surface.point - Frame().shift).norm(), 1e-6);
}

TEST(FitSurface, FindsAConesRadiusAndAngle) {
  // Radius 12 mm at the origin, half angle 5 degrees, a half of it.
  const double slope = 5.0 * geometry::kDegree;
  const Patch patch = sampled([&](double u, double v) {
    const double t = std::numbers::pi * (u - 0.5), z = 60.0 * (v - 0.5);
    const Vec3 out(std::cos(t), std::sin(t), 0.0);
    return std::pair(Vec3((12.0 + z * std::tan(slope)) * out + z * Vec3::UnitZ()),
                     Vec3(std::cos(slope) * out - std::sin(slope) * Vec3::UnitZ()));
  });
  const SurfaceFit fit = fit_surface(product::FaceKind::kCone, patch.points, patch.normals);
  ASSERT_TRUE(fit.has_converged);
  EXPECT_NEAR(fit.surface.half_angle, slope, 1e-7);
  expect_axis(fit.surface, 1e-6);
  const Vec3 way = Frame().shift - fit.surface.point;
  EXPECT_NEAR(fit.surface.radius + way.dot(fit.surface.axis) * std::tan(slope), 12.0, 1e-5);
  // It widens towards +z of the frame.
  EXPECT_GT(fit.surface.axis.dot(Frame().turn * Vec3::UnitZ()), 0.99);
}

TEST(FitSurface, FindsATorusFromAnOuterAnInnerAndAWholePatch) {
  for (const Patch& patch :
       {torus(120.0, 14.0, 0.5, 1.5), torus(120.0, 14.0, 0.5, 1.5, 0.0, std::numbers::pi),
        torus(30.0, 8.0, 2.0 * std::numbers::pi, 2.0 * std::numbers::pi)}) {
    const bool is_whole = patch.points.front().norm() < 100.0 && patch.points.size() == 900 &&
                          (patch.points.front() - patch.points.back()).norm() < 10.0;
    const SurfaceFit fit = fit_surface(product::FaceKind::kTorus, patch.points, patch.normals);
    ASSERT_TRUE(fit.has_converged);
    EXPECT_NEAR(fit.surface.radius, is_whole ? 30.0 : 120.0, 1e-4);
    EXPECT_NEAR(fit.surface.tube_radius, is_whole ? 8.0 : 14.0, 1e-5);
    EXPECT_LT(fit.rms, 1e-7);
  }
}

TEST(FitSurface, ReportsTheNoiseAsItsResidual) {
  // Least squares of 900 points with 5 parameters: rms 0.1 sqrt(895 / 900) mm, itself known to
  // 0.1 / sqrt(1800) = 2.4 %: four of these.
  const SurfaceFit fit =
      fit_surface(product::FaceKind::kCylinder, cylinder(17.5, 2.0, 60.0, 0.1).points, {});
  ASSERT_TRUE(fit.has_converged);
  EXPECT_NEAR(fit.rms, 0.1, 0.01);
  EXPECT_NEAR(fit.surface.radius, 17.5, 0.1);
  EXPECT_GT(fit.max, 2.0 * fit.rms);
  EXPECT_LT(fit.max, 5.0 * fit.rms);
}

TEST(ChooseSurface, TakesTheSimplestThatIsGoodEnough) {
  const auto kind = [](const Patch& patch) {
    return choose_surface(patch.points, patch.normals).best().surface.kind;
  };
  EXPECT_EQ(kind(sampled([](double u, double v) {
              return std::pair(Vec3(40.0 * u, 30.0 * v, 0.0), Vec3::UnitZ().eval());
            })),
            product::FaceKind::kPlane);
  EXPECT_EQ(kind(cylinder(16.0, 1.5, 50.0)), product::FaceKind::kCylinder);
  EXPECT_EQ(kind(cylinder(16.0, 1.5, 50.0, 0.2)), product::FaceKind::kCylinder);
  EXPECT_EQ(kind(torus(40.0, 12.0, 1.0, 1.5)), product::FaceKind::kTorus);
  EXPECT_EQ(kind(torus(40.0, 12.0, 1.0, 1.5, 0.1)), product::FaceKind::kTorus);
  // So flat that 0.05 mm don't show: sagitta 10^2 / 8 / 5000 mm.
  EXPECT_EQ(kind(cylinder(5000.0, 10.0 / 5000.0, 10.0)), product::FaceKind::kPlane);
}

TEST(ChooseSurface, IsTheSameForAPatchThatWasMovedAndTurned) {
  const Patch patch = torus(40.0, 12.0, 1.0, 1.5, 0.1);
  Patch other = patch;
  const Quat turn(Eigen::AngleAxisd(2.0, Vec3(1.0, 2.0, -0.5).normalized()));
  for (Vec3& x : other.points) x = turn * x + Vec3(100.0, 0.0, -30.0);
  for (Vec3& n : other.normals) n = turn * n;
  const SurfaceFit a = choose_surface(patch.points, patch.normals).best();
  const SurfaceFit b = choose_surface(other.points, other.normals).best();
  EXPECT_NEAR(a.surface.radius, b.surface.radius, 1e-4);
  EXPECT_NEAR(a.surface.tube_radius, b.surface.tube_radius, 1e-4);
  EXPECT_NEAR(a.rms, b.rms, 1e-7);
}

TEST(SplitPatch, CutsAPatchOverAnEdgeIntoItsTwoPlanes) {
  Patch patch;
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 10; ++j) {
      patch.points.emplace_back(i, 1.0 + j, 0.0);
      patch.normals.emplace_back(0.0, 0.0, 1.0);
      patch.points.emplace_back(i, 0.0, -1.0 - j);
      patch.normals.emplace_back(0.0, -1.0, 0.0);
    }
  }
  const auto pieces = split_patch(patch.points, patch.normals);
  ASSERT_EQ(pieces.size(), 2U);
  for (const auto& piece : pieces) {
    EXPECT_EQ(piece.size(), 200U);
    for (const int i : piece) EXPECT_EQ(i % 2, piece.front() % 2);  // as they were made
  }
  // What one surface suits stays whole.
  EXPECT_EQ(split_patch(cylinder(16.0, 3.0, 50.0).points, cylinder(16.0, 3.0, 50.0).normals).size(),
            1U);
}

TEST(DistanceTo, IsOrthogonal) {
  // Hand calculation: 3 mm above the middle of a tube of radius 2: 1 mm outside.
  const SimpleSurface ring{.kind = product::FaceKind::kTorus, .radius = 10.0, .tube_radius = 2.0};
  EXPECT_NEAR(distance_to(ring, Vec3(10.0, 0.0, 3.0)), 1.0, 1e-12);
  EXPECT_NEAR(distance_to(ring, Vec3(0.0, 0.0, 0.0)), 8.0, 1e-12);
  // On a cone of half angle 30 degrees, 1 mm off along the normal.
  const SimpleSurface cone{
      .kind = product::FaceKind::kCone, .radius = 5.0, .half_angle = std::numbers::pi / 6.0};
  const Vec3 on(5.0 + 4.0 * std::tan(std::numbers::pi / 6.0), 0.0, 4.0);
  const Vec3 normal(std::cos(std::numbers::pi / 6.0), 0.0, -std::sin(std::numbers::pi / 6.0));
  EXPECT_NEAR(distance_to(cone, on), 0.0, 1e-12);
  EXPECT_NEAR(distance_to(cone, on + normal), 1.0, 1e-12);
}

TEST(FitSurface, SaysWhatItNeeds) {
  const std::vector<Vec3> four = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ(), Vec3::Zero()};
  EXPECT_THAT(
      [&] { fit_surface(product::FaceKind::kCylinder, four, {}); },
      ::testing::ThrowsMessage<UsageError>("surface fit: 4 points; a cylinder needs at least 5"));
  EXPECT_THAT([&] { fit_surface(product::FaceKind::kSphere, four, std::vector<Vec3>(3)); },
              ::testing::ThrowsMessage<UsageError>("surface fit: 3 normals for 4 points"));
  const std::vector<Vec3> line = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(3, 0, 0),
                                  Vec3(4, 0, 0)};
  EXPECT_EQ(choose_surface(line, {}).best().surface.kind, product::FaceKind::kPlane);
}

}  // namespace
}  // namespace palmar::redesign
