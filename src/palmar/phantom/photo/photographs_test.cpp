// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/phantom/photo/photographs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "palmar/capture/photo/photo_model.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar {
namespace {

/// 12 small pictures in two rings.
PhotographsOptions small_options() {
  PhotographsOptions options;
  options.cameras = 6;
  options.positions = 2;
  options.step = 30.0;
  options.width = 210;
  options.height = 300;
  options.focal = 2.4;
  options.texture = 0.15;
  options.noise = 2.0;
  options.middle = 45.0;
  return options;
}

/// An egg of 50 x 40 x 80 mm that stands on the board, skin-coloured with a blue dot.
ColouredMesh make_egg() {
  ColouredMesh egg{make_icosphere(1.0, 5), {}};
  for (Vec3& vertex : egg.mesh.vertices) {
    vertex = Vec3(25.0 * vertex.x(), 20.0 * vertex.y(), 40.0 * vertex.z() + 42.0);
    const bool is_dot = (vertex - Vec3(0, -20, 42)).norm() < 3.0;
    egg.colour.push_back(is_dot ? Srgb(0.12F, 0.2F, 0.62F) : Srgb(0.8F, 0.6F, 0.5F));
  }
  return egg;
}

std::vector<Photograph> take_all(const ColouredMesh& object, const PhotographsOptions& options) {
  const PhotographsStage stage(object, {}, options);
  const PhotoShoot shoot = plan_photographs(options);
  std::vector<Photograph> photographs;
  for (std::size_t n = 0; n < shoot.shots.size(); ++n) {
    const PhotoShot& shot = shoot.shots[n];
    const Rigid3& moved = shoot.board_from_hand[shot.position];
    photographs.push_back({std::to_string(n), stage.take(shot, moved, static_cast<int>(n)),
                           shot.pose, shot.position});
  }
  return photographs;
}

TEST(Photographs, APointIsSeenWhereTheCameraSaysSo) {
  PhotographsOptions options = small_options();
  options.noise = options.blur = options.aperture = options.texture = 0.0;
  const ColouredMesh egg = make_egg();
  const PhotographsStage stage(egg, {}, options);
  PhotoShot shot = plan_photographs(options).shots[0];
  shot.pose.camera_from_world = looking_at(Vec3(0, -400, 100), Vec3(0, 0, 45));
  const RgbImage image = stage.take(shot, {}, 0);
  // Middle of the blue pixels inside of the egg, against the dot's own place.
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double count = 0.0;
  const Eigen::Vector2d middle = *shot.pose.project(Vec3(0, -20, 42));
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const std::size_t at = pixel_offset(image, x, y);
      if ((Eigen::Vector2d(x, y) - middle).norm() > 12.0 || image.rgb[at + 2] <= image.rgb[at]) {
        continue;
      }
      sum += Eigen::Vector2d(x, y);
      count += 1.0;
    }
  }
  ASSERT_GT(count, 20.0);
  EXPECT_NEAR((sum / count - middle).norm(), 0.0, 0.6);  // pixels; the dot is bent over the egg
}

TEST(Photographs, GiveBackTheSurfaceTheyShow) {
  const ColouredMesh egg = make_egg();
  PhotoModelOptions options;
  options.box = Box3(Vec3(-40, -40, 0), Vec3(40, 40, 95));
  const PhotoModel model = make_photo_model(take_all(egg, small_options()), options);

  const ClosestPointQuery query(egg.mesh);
  std::vector<double> errors;
  double sum = 0.0;
  std::size_t blue = 0;
  for (std::size_t v = 0; v < model.skin.mesh.vertices.size(); ++v) {
    const Vec3& vertex = model.skin.mesh.vertices[v];
    const Srgb& colour = model.skin.colour[v];
    if (model.measured[v] != 0 && vertex.z() > 20.0 && colour[2] > colour[0]) {
      EXPECT_LT((vertex - Vec3(0, -20, 42)).norm(), 4.5);
      ++blue;
    }
    if (model.measured[v] == 0) continue;
    errors.push_back(query.closest(vertex)->distance);
    sum += errors.back();
  }
  EXPECT_GT(blue, 8U);
  std::sort(errors.begin(), errors.end());
  // mm; a pixel of these small pictures covers 0.65 mm before any reduction.
  EXPECT_LT(sum / static_cast<double>(errors.size()), 0.45);
  EXPECT_LT(errors[errors.size() * 95 / 100], 1.2);
  EXPECT_GT(model.measured_share, 0.7);
}

TEST(Photographs, FailuresAreNamed) {
  PhotographsOptions options = small_options();
  options.noise = options.texture = 0.0;
  std::vector<Photograph> photographs = take_all({}, options);  // the board alone
  PhotoModelOptions box;
  box.box = Box3(Vec3(-40, -40, 0), Vec3(40, 40, 95));
  const auto message = [&](const std::vector<Photograph>& set) -> std::string {
    try {
      make_photo_model(set, box);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(message(photographs), testing::HasSubstr("outlines of the hand"));
  photographs.resize(4);
  EXPECT_THAT(message(photographs), testing::HasSubstr("4 photographs"));
}

TEST(Photographs, AnyNumberOfThreadsTakesTheSame) {
  const ColouredMesh egg = make_egg();
  PhotographsOptions options = small_options();
  const PhotographsStage stage(egg, {}, options);
  const PhotoShot shot = plan_photographs(options).shots[3];
  set_thread_count(1);
  const RgbImage one = stage.take(shot, {}, 3);
  set_thread_count(3);
  const RgbImage three = stage.take(shot, {}, 3);
  set_thread_count(0);
  EXPECT_EQ(one.rgb, three.rgb);
}

}  // namespace
}  // namespace palmar
