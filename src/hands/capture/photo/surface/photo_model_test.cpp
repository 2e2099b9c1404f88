// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/photo/surface/photo_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hands/capture/photo/drawn_rod_test.h"

namespace palmar::capture {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

PhotoModel model_of(const DrawnRod& rod, int count, const std::vector<double>& heights) {
  PhotoModelOptions options;
  options.box = Box3(Vec3(-20, -20, 0), Vec3(20, 20, rod.top + 12));
  options.board_half = 0.0;
  return make_photo_model(rod.photographs(count, heights, 0.5), options);
}

/// Mean of the distances of the vertices between two heights that were measured.
double mean_distance(const PhotoModel& model, const DrawnRod& rod, double from, double to) {
  double sum = 0.0, count = 0.0;
  for (std::size_t v = 0; v < model.skin.mesh.vertices.size(); ++v) {
    const Vec3& p = model.skin.mesh.vertices[v];
    if (model.measured[v] == 0 || p.z() < from || p.z() > to) continue;
    sum += rod.distance(p);
    count += 1.0;
  }
  return sum / count;
}

TEST(PhotoModel, ARodIsAsThickAsItIs) {
  // Flat patches of 3.5 mm alone make its radius 0.10 mm and its end 0.22 mm too small.
  const DrawnRod rod;
  const PhotoModel model = model_of(rod, 24, {20.0, 46.0});
  EXPECT_NEAR(mean_distance(model, rod, 10.0, 50.0), 0.0, 0.03);  // mm
  EXPECT_NEAR(mean_distance(model, rod, 56.0, 61.0), 0.0, 0.06);
  EXPECT_GT(model.measured_share, 0.97);
  EXPECT_THAT(model.warnings, Not(Contains(HasSubstr("one height only"))));
  EXPECT_THAT(model.warnings, Not(Contains(HasSubstr("hardly show the skin's texture"))));
}

TEST(PhotoModel, FromOneHeightLessIsCalledMeasured) {
  DrawnRod rod;
  // Shining, hardly uneven skin: photographs agree about the mirrored lamps, inside of the end.
  rod.texture = 0.04;
  rod.noise = 6.0;
  rod.gloss = 0.1;
  const PhotoModel model = model_of(rod, 18, {20.0});
  EXPECT_THAT(model.warnings, Contains(HasSubstr("one height only: the cameras all look from 2")));
  EXPECT_THAT(model.warnings, Contains(HasSubstr("higher")));
  double wrong = 0.0, measured = 0.0, all_wrong = 0.0;
  for (std::size_t v = 0; v < model.measured.size(); ++v) {
    const bool is_wrong = std::abs(rod.distance(model.skin.mesh.vertices[v])) > 1.0;  // mm
    all_wrong += is_wrong ? 1.0 : 0.0;
    if (model.measured[v] == 0) continue;
    measured += 1.0;
    wrong += is_wrong ? 1.0 : 0.0;
  }
  EXPECT_GT(all_wrong / static_cast<double>(model.measured.size()), 0.015);  // or it shows nothing
  EXPECT_LT(wrong / measured, 0.01);
  EXPECT_GT(model.measured_share, 0.8);
}

TEST(PhotoModel, SkinThatHardlyShowsTextureIsComparedInLargerPatches) {
  DrawnRod rod;
  rod.texture = 0.03;
  rod.noise = 10.0;
  const PhotoModel model = model_of(rod, 24, {20.0, 46.0});
  EXPECT_THAT(model.warnings, Contains(HasSubstr("hardly show the skin's texture")));
  EXPECT_NEAR(mean_distance(model, rod, 10.0, 50.0), 0.0, 0.15);  // mm
  EXPECT_GT(model.measured_share, 0.8);
}

}  // namespace
}  // namespace palmar::capture
