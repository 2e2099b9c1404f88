// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/rotation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palmar/core/random.h"

namespace palmar::geometry {
namespace {

std::vector<Vec3> cloud(int count, std::uint64_t seed) {
  RandomStream random(seed, 0);
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    points.emplace_back(x - 0.5, y - 0.5, z - 0.5);
  }
  return points;
}

Eigen::Matrix3d sum_of(const std::vector<Vec3>& x, const std::vector<Vec3>& y) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < x.size(); ++i) sum += y[i] * x[i].transpose();
  return sum;
}

TEST(FitRotation, FindsTheTurnBetweenTwoClouds) {
  const Quat truth(Eigen::AngleAxisd(2.9, Vec3(1.0, -2.0, 0.5).normalized()));
  const std::vector<Vec3> x = cloud(20, 3);
  std::vector<Vec3> y;
  for (const Vec3& p : x) y.push_back(truth * p);
  EXPECT_LT((fit_rotation(sum_of(x, y)) - truth.toRotationMatrix()).norm(), 1e-12);
}

TEST(FitRotation, IsNeverAReflection) {
  // Mirrored in the thinnest direction: no turn at all comes nearest.
  const Eigen::Matrix3d mirrored = Vec3(3.0, 2.0, -1.0).asDiagonal();
  const Eigen::Matrix3d found = fit_rotation(mirrored);
  EXPECT_NEAR(found.determinant(), 1.0, 1e-12);
  EXPECT_LT((found - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  // No rotation near it has a larger trace(R^T sum), which is what is asked.
  for (const Vec3& axis : cloud(30, 8)) {
    const Eigen::Matrix3d other =
        Eigen::AngleAxisd(0.2, axis.normalized()).toRotationMatrix() * found;
    EXPECT_LT((other.transpose() * mirrored).trace(), (found.transpose() * mirrored).trace());
  }
}

TEST(FitRotation, OfPointsInAPlaneAndOnALineIsARotation) {
  const Quat truth(Eigen::AngleAxisd(1.1, Vec3(0.2, 1.0, -0.4).normalized()));
  for (const Vec3& flat : {Vec3(1.0, 1.0, 0.0), Vec3(1.0, 0.0, 0.0)}) {
    std::vector<Vec3> x, y;
    for (const Vec3& p : cloud(12, 4)) {
      x.push_back(p.cwiseProduct(flat));
      y.push_back(truth * x.back());
    }
    const Eigen::Matrix3d found = fit_rotation(sum_of(x, y));
    EXPECT_NEAR(found.determinant(), 1.0, 1e-9);
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_LT((found * x[i] - y[i]).norm(), 1e-9);
  }
}

TEST(ShortestRotation, TurnsAboutTheNormalOfBoth) {
  const Quat found = shortest_rotation(Vec3(2.0, 0.0, 0.0), Vec3(0.0, 0.5, 0.0));
  EXPECT_NEAR(found.angularDistance(Quat(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitZ()))),
              0.0, 1e-12);
  const Quat half = shortest_rotation(Vec3::UnitY(), Vec3(0.0, -3.0, 0.0));
  EXPECT_LT((half * Vec3::UnitY() + Vec3::UnitY()).norm(), 1e-6);
}

}  // namespace
}  // namespace palmar::geometry
