// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/photo/surface/hand_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palmar/core/random.h"

namespace palmar::capture {
namespace {

/// Points on a cylinder 40 mm thick above the board, seen from their side by 18 cameras of 6
/// positions; every point seen twice or more is matched, and some matches are wrong.
struct MotionScene {
  std::vector<PhotoCamera> cameras;
  std::vector<int> position;
  std::vector<geometry::Rigid3> truth;
  PointMatches matches;

  MotionScene(double shift, double turn) {
    RandomStream random(9, 0);
    constexpr int kPositions = 6, kRig = 3, kPoints = 400;
    for (int p = 0; p < kPositions; ++p) {
      const Vec3 axis = Vec3(random.normal(), random.normal(), random.normal()).normalized();
      geometry::Rigid3 motion;
      if (p > 0) {
        motion = geometry::Rigid3::about_axis(axis, Vec3(0, 0, 90), turn * random.normal());
        motion.translation += shift * Vec3(random.normal(), random.normal(), random.normal());
      }
      truth.push_back(motion);
      for (int c = 0; c < kRig; ++c) {
        const double azimuth = (120.0 * c + 20.0 * p) * std::numbers::pi / 180.0;
        const double height = c == 1 ? 300.0 : 150.0;
        PhotoCamera camera;
        camera.lens = {.width = 540,
                       .height = 720,
                       .focal_x = 900,
                       .focal_y = 900,
                       .centre_x = 270,
                       .centre_y = 360};
        camera.camera_from_world = looking_at(
            Vec3(420 * std::cos(azimuth), 420 * std::sin(azimuth), height), Vec3(0, 0, 90));
        cameras.push_back(camera);
        position.push_back(p);
      }
    }
    matches.point.resize(cameras.size());
    std::vector<std::vector<int>> index(cameras.size(), std::vector<int>(kPoints, -1));
    for (int n = 0; n < kPoints; ++n) {
      const double angle = 2.0 * std::numbers::pi * random.uniform();
      const Vec3 normal(std::cos(angle), std::sin(angle), 0.0);
      const Vec3 point = 20.0 * normal + Vec3(0, 0, 20 + 150 * random.uniform());
      for (std::size_t i = 0; i < cameras.size(); ++i) {
        const Vec3 there = truth[position[i]] * point;
        if (normal.dot((cameras[i].centre() - there).normalized()) < 0.5) continue;
        const Eigen::Vector2d pixel = *cameras[i].project(there);
        index[i][n] = static_cast<int>(matches.point[i].size());
        matches.point[i].push_back({static_cast<float>(pixel.x() + 0.2 * random.normal()),
                                    static_cast<float>(pixel.y() + 0.2 * random.normal())});
      }
    }
    for (std::size_t a = 0; a < cameras.size(); ++a) {
      for (std::size_t b = a + 1; b < cameras.size(); ++b) {
        std::vector<std::array<int, 2>> pairs;
        for (std::size_t n = 0; n < kPoints; ++n) {
          if (index[a][n] < 0 || index[b][n] < 0) continue;
          const bool is_wrong = random.uniform() < 0.05;
          const auto other =
              is_wrong ? static_cast<int>(random.below(matches.point[b].size())) : index[b][n];
          pairs.push_back({index[a][n], other});
        }
        if (pairs.empty()) continue;
        matches.pair.push_back({static_cast<int>(a), static_cast<int>(b)});
        matches.match.push_back(std::move(pairs));
      }
    }
  }

  /// How far a motion is from the truth on a fingertip or the wrist, mm.
  double error(const HandMotion& found) const {
    double largest = 0.0;
    for (std::size_t p = 0; p < truth.size(); ++p) {
      for (const Vec3& point : {Vec3(0, 0, 10), Vec3(20, 0, 170)}) {
        largest = std::max(largest, (found.board_from_hand[p] * point - truth[p] * point).norm());
      }
    }
    return largest;
  }
};

TEST(FitHandMotion, FindsHowTheHandMoved) {
  const MotionScene scene(0.6, 0.009);
  const HandMotion found = fit_hand_motion(scene.cameras, scene.position, scene.matches);
  EXPECT_TRUE(found.is_applied);
  EXPECT_GT(found.tracks, 200);
  EXPECT_LT(found.after, 0.5 * found.before);
  EXPECT_GT(scene.error(HandMotion{.board_from_hand = std::vector<geometry::Rigid3>(6)}), 1.0);
  EXPECT_LT(scene.error(found), 0.3);  // mm; noise of 0.2 pixels of 0.5 mm
}

TEST(FitHandMotion, AHandThatStoodStillStays) {
  const MotionScene scene(0.0, 0.0);
  const HandMotion found = fit_hand_motion(scene.cameras, scene.position, scene.matches);
  EXPECT_FALSE(found.is_applied);
  for (const geometry::Rigid3& motion : found.board_from_hand)
    EXPECT_EQ(motion.translation.norm(), 0.0);
}

TEST(FitHandMotion, WithoutPointsNothingIsSaid) {
  MotionScene scene(0.6, 0.009);
  for (auto& pairs : scene.matches.match) pairs.clear();
  const HandMotion found = fit_hand_motion(scene.cameras, scene.position, scene.matches);
  EXPECT_EQ(found.tracks, 0);
  EXPECT_FALSE(found.is_applied);
}

}  // namespace
}  // namespace palmar::capture
