// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/phantom/photo/photographs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "hands/capture/photo/surface/photo_model.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::phantom {
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
geometry::ColouredMesh make_egg() {
  geometry::ColouredMesh egg{geometry::make_icosphere(1.0, 5), {}};
  for (Vec3& vertex : egg.mesh.vertices) {
    vertex = Vec3(25.0 * vertex.x(), 20.0 * vertex.y(), 40.0 * vertex.z() + 42.0);
    const bool is_dot = (vertex - Vec3(0, -20, 42)).norm() < 3.0;
    egg.colour.push_back(is_dot ? geometry::Srgb(0.12F, 0.2F, 0.62F)
                                : geometry::Srgb(0.8F, 0.6F, 0.5F));
  }
  return egg;
}

std::vector<capture::Photograph> take_all(const geometry::ColouredMesh& object,
                                          const PhotographsOptions& options) {
  const PhotographsStage stage(object, {}, options);
  const PhotoShoot shoot = plan_photographs(options);
  std::vector<capture::Photograph> photographs;
  for (std::size_t n = 0; n < shoot.shots.size(); ++n) {
    const PhotoShot& shot = shoot.shots[n];
    const geometry::Rigid3& moved = shoot.board_from_hand[shot.position];
    photographs.push_back({std::to_string(n), stage.take(shot, moved, static_cast<int>(n)),
                           shot.pose, shot.position});
  }
  return photographs;
}

/// Middle of the blue pixels near a place: the egg's dot.
Eigen::Vector2d blue_middle(const geometry::RgbImage& image, const Eigen::Vector2d& near) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double count = 0.0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const std::size_t at = capture::pixel_offset(image, x, y);
      if ((Eigen::Vector2d(x, y) - near).norm() > 12.0 || image.rgb[at + 2] <= image.rgb[at]) {
        continue;
      }
      sum += Eigen::Vector2d(x, y);
      count += 1.0;
    }
  }
  EXPECT_GT(count, 20.0);
  return sum / count;
}

TEST(Photographs, APointIsSeenWhereTheCameraSaysSo) {
  PhotographsOptions options = small_options();
  options.noise = options.blur = options.aperture = options.texture = 0.0;
  const geometry::ColouredMesh egg = make_egg();
  const PhotographsStage stage(egg, {}, options);
  PhotoShot shot = plan_photographs(options).shots[0];
  shot.pose.camera_from_world = capture::looking_at(Vec3(0, -400, 100), Vec3(0, 0, 45));
  const geometry::RgbImage image = stage.take(shot, {}, 0);
  const Eigen::Vector2d middle = *shot.pose.project(Vec3(0, -20, 42));
  // pixels; the dot is bent over the egg
  EXPECT_NEAR((blue_middle(image, middle) - middle).norm(), 0.0, 0.6);
}

TEST(Photographs, ALensMayHaveTermsThatPalmarDoesNotCalibrate) {
  // Brown 1966 by hand at (0.3, 0.4), r = 0.5.
  const Eigen::Vector2d by_p1 = bent({.p1 = 0.01}, {0.3, 0.4});
  EXPECT_NEAR(by_p1.x(), 0.3 + 2 * 0.01 * 0.12, 1e-15);
  EXPECT_NEAR(by_p1.y(), 0.4 + 0.01 * (0.25 + 2 * 0.16), 1e-15);
  const Eigen::Vector2d by_p2 = bent({.p2 = 0.01}, {0.3, 0.4});
  EXPECT_NEAR(by_p2.x(), 0.3 + 0.01 * (0.25 + 2 * 0.09), 1e-15);
  EXPECT_NEAR(by_p2.y(), 0.4 + 2 * 0.01 * 0.12, 1e-15);
  EXPECT_NEAR(bent({.k3 = 0.5}, {0.3, 0.4}).norm(), 0.5 * (1.0 + 0.5 * std::pow(0.5, 6)), 1e-15);
  // And in a picture: the dot is seen by the pixel whose bent direction meets it.
  PhotographsOptions options = small_options();
  options.noise = options.blur = options.aperture = options.texture = 0.0;
  options.focal = 1.0;
  options.decentring = 0.01;
  const geometry::ColouredMesh egg = make_egg();
  const PhotographsStage stage(egg, {}, options);
  PhotoShot shot = plan_photographs(options).shots[0];
  shot.pose.camera_from_world = capture::looking_at(Vec3(0, -250, 100), Vec3(60, 0, 130));
  const LensTerms terms = lens_terms(options, shot.camera);
  const Vec3 dot = shot.pose.camera_from_world * Vec3(0, -20, 42);
  const Eigen::Vector2d towards = dot.hnormalized();
  Eigen::Vector2d unbent = towards;
  for (int k = 0; k < 20; ++k) unbent -= bent(terms, unbent) - towards;
  const auto pixel = [&](const Eigen::Vector2d& direction) {
    return *shot.pose.project(shot.pose.camera_from_world.inverse() *
                              Vec3(dot.z() * direction.homogeneous()));
  };
  const Eigen::Vector2d expected = pixel(unbent), plain = pixel(towards);
  ASSERT_GT((expected - plain).norm(), 0.5);  // pixels; otherwise nothing is tested
  const Eigen::Vector2d seen = blue_middle(stage.take(shot, {}, 0), expected);
  options.decentring = 0.0;
  const PhotographsStage straight(egg, {}, options);
  const Eigen::Vector2d without = blue_middle(straight.take(shot, {}, 0), plain);
  EXPECT_NEAR((seen - without - (expected - plain)).norm(), 0.0, 0.2);
}

TEST(Photographs, CornersGetLessLightByTheirDistance) {
  PhotographsOptions options = small_options();
  options.noise = options.blur = options.texture = options.exposure = 0.0;
  PhotoShot shot = plan_photographs(options).shots[0];
  shot.pose.camera_from_world = capture::looking_at(Vec3(0, -1, 400), Vec3(0, 0, 0));
  shot.gain = 0.4;  // nothing is as white as white gets
  const geometry::RgbImage even = PhotographsStage({}, {}, options).take(shot, {}, 0);
  options.vignetting = 0.4;
  const geometry::RgbImage dark = PhotographsStage({}, {}, options).take(shot, {}, 0);
  const auto linear = [](std::uint8_t srgb) {
    return std::pow((srgb / 255.0 + 0.055) / 1.055, 2.4);
  };
  // Half way to the corner a quarter of the loss: 10 %; at the corner 40 %.
  for (const auto& [x, y, left] : {std::array{52.0, 75.0, 0.9}, std::array{1.0, 1.0, 0.605}}) {
    const std::size_t at = capture::pixel_offset(even, static_cast<int>(x), static_cast<int>(y));
    EXPECT_NEAR(linear(dark.rgb[at]) / linear(even.rgb[at]), left, 0.015) << x;
  }
}

TEST(Photographs, GiveBackTheSurfaceTheyShow) {
  const geometry::ColouredMesh egg = make_egg();
  capture::PhotoModelOptions options;
  options.box = Box3(Vec3(-40, -40, 0), Vec3(40, 40, 95));
  const capture::PhotoModel model =
      capture::make_photo_model(take_all(egg, small_options()), options);

  const geometry::ClosestPointQuery query(egg.mesh);
  std::vector<double> errors;
  double sum = 0.0;
  std::size_t blue = 0;
  for (std::size_t v = 0; v < model.skin.mesh.vertices.size(); ++v) {
    const Vec3& vertex = model.skin.mesh.vertices[v];
    const geometry::Srgb& colour = model.skin.colour[v];
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
  std::vector<capture::Photograph> photographs = take_all({}, options);  // the board alone
  capture::PhotoModelOptions box;
  box.box = Box3(Vec3(-40, -40, 0), Vec3(40, 40, 95));
  const auto message = [&](const std::vector<capture::Photograph>& set) -> std::string {
    try {
      capture::make_photo_model(set, box);
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
  const geometry::ColouredMesh egg = make_egg();
  PhotographsOptions options = small_options();
  const PhotographsStage stage(egg, {}, options);
  const PhotoShot shot = plan_photographs(options).shots[3];
  set_thread_count(1);
  const geometry::RgbImage one = stage.take(shot, {}, 3);
  set_thread_count(3);
  const geometry::RgbImage three = stage.take(shot, {}, 3);
  set_thread_count(0);
  EXPECT_EQ(one.rgb, three.rgb);
}

}  // namespace
}  // namespace palmar::phantom
