// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/mri/bones/image_registration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "palmar/core/error.h"
#include "palmar/core/random.h"
#include "palmar/geometry/degrees.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

// A bone drawn by a formula: an ellipsoid of marrow in a dark shell with a knob at one end, in
// tissue whose pattern doesn't move with it.

namespace palmar::capture {
namespace {

using ::testing::HasSubstr;

constexpr double kMarrow = 200.0;

struct Scanner {
  Vec3 spacing = Vec3(0.8, 0.8, 1.0);
  Quat turn = Quat::Identity();  ///< of the slices
  double noise = 8.0;            ///< deviation, Rician
  double gain = 1.0, slope = 0.0, offset = 0.0;
  std::uint64_t seed = 1;
};

class ImageRegistration : public ::testing::Test {
 protected:
  Vec3 half_ = Vec3(16.0, 6.0, 4.5);  ///< half axes of the bone's outside, mm
  double knob_ = 2.5;                 ///< radius, mm; 0: none

  double signal(const Vec3& p) const {
    // Distance by first order; edges soft over half a millimetre, as voxels make them.
    const double f = std::sqrt(p.cwiseQuotient(half_).squaredNorm());
    const double slope = p.cwiseQuotient(half_.cwiseAbs2()).norm() / std::max(f, 1e-9);
    double depth = (1.0 - f) / std::max(slope, 1e-9);
    if (knob_ > 0.0) {
      depth = std::max(depth, knob_ - (p - Vec3(9.0, 5.0, 2.0)).norm());
    }
    const auto step = [](double d) { return 1.0 / (1.0 + std::exp(-d / 0.25)); };
    return kMarrow * step(depth - 1.2) - 100.0 * step(depth);
  }

  /// The bone where `place` puts it.
  imaging::Volume image_of(const geometry::Rigid3& place, const Scanner& scanner) const {
    imaging::Volume image;
    imaging::VolumeGrid& grid = image.grid;
    grid.spacing = scanner.spacing;
    grid.axes = scanner.turn.toRotationMatrix();
    const Vec3 field(52.0, 52.0, 52.0);
    for (int a = 0; a < 3; ++a) {
      grid.size[a] = static_cast<int>(field[a] / grid.spacing[a]);
    }
    const Vec3 middle(grid.size[0] - 1.0, grid.size[1] - 1.0, grid.size[2] - 1.0);
    grid.origin = place.translation - grid.axes * (0.5 * middle).cwiseProduct(grid.spacing);
    image.value.resize(grid.count());
    RandomStream random(scanner.seed, 0);
    const geometry::Rigid3 bone_from_image = place.inverse();
    for (int k = 0; k < grid.size[2]; ++k) {
      for (int j = 0; j < grid.size[1]; ++j) {
        for (int i = 0; i < grid.size[0]; ++i) {
          const Vec3 p = grid.to_patient(Vec3(i, j, k));
          double v = 115.0 + 12.0 * std::sin(0.35 * p.x() + 0.2 * p.z()) * std::cos(0.3 * p.y()) +
                     signal(bone_from_image * p);
          v *= scanner.gain * std::exp(scanner.slope * (p - place.translation).x());
          v += scanner.offset;
          image.value[grid.at(i, j, k)] = static_cast<float>(
              std::hypot(v + scanner.noise * random.normal(), scanner.noise * random.normal()));
        }
      }
    }
    return image;
  }

  geometry::TriangleMesh bone_mesh() const {
    geometry::TriangleMesh mesh = geometry::make_icosphere(1.0, 4);
    for (Vec3& v : mesh.vertices) v = v.cwiseProduct(half_);
    return mesh;
  }

  static geometry::Rigid3 truth() {
    return {Quat(Eigen::AngleAxisd(40.0 * geometry::kDegree, Vec3(1.0, 2.0, -0.5).normalized())),
            Vec3(7.0, -3.0, 12.0)};
  }

  /// The truth turned and shifted.
  static geometry::Rigid3 near_truth(double turn, const Vec3& shift) {
    geometry::Rigid3 start = truth();
    start.rotation =
        start.rotation * Quat(Eigen::AngleAxisd(turn, Vec3(0.5, -1.0, 1.5).normalized()));
    start.translation += shift;
    return start;
  }

  BoneImage reference(const Scanner& scanner) const {
    return {bone_mesh(), blurred_levels(image_of({}, scanner))};
  }

  static double turn_off(const ImageFit& fit) {
    return fit.fixed_from_moving.rotation.angularDistance(truth().rotation);
  }
  static double shift_off(const ImageFit& fit) {
    return (fit.fixed_from_moving.translation - truth().translation).norm();
  }
};

TEST_F(ImageRegistration, MotionsAreFoundToAFractionOfAVoxelDespiteNoise) {
  for (const double noise : {0.0, 8.0, 20.0}) {
    const BoneImage bone = reference({.noise = noise, .seed = 3});
    const ImageLevels other = blurred_levels(image_of(truth(), {.noise = noise, .seed = 4}));
    const ImageFit fit =
        bone.fit(other, near_truth(10.0 * geometry::kDegree, Vec3(1.5, -1.5, 1.0)));
    EXPECT_TRUE(fit.has_converged) << noise;
    EXPECT_EQ(fit.overlap, 1.0);
    // Two images' noise of 4 % each: what the normal equations expect, and no more.
    EXPECT_LT(turn_off(fit), std::max(0.3 * geometry::kDegree, 3.0 * fit.turn_error)) << noise;
    EXPECT_LT(shift_off(fit), std::max(0.05, 3.0 * fit.shift_error)) << noise;
    EXPECT_LT(fit.turn_error, noise > 10.0 ? 3.0 * geometry::kDegree : 1.5 * geometry::kDegree)
        << noise;
    EXPECT_GT(fit.correlation, noise > 10.0 ? 0.85 : 0.95) << noise;
  }
}

TEST_F(ImageRegistration, GainFieldAndOffsetDontMatter) {
  const BoneImage bone = reference({.seed = 5});
  const ImageLevels other = blurred_levels(
      image_of(truth(), {.noise = 12.0, .gain = 1.6, .slope = 0.006, .offset = 25.0, .seed = 6}));
  const ImageFit fit = bone.fit(other, near_truth(6.0 * geometry::kDegree, Vec3(1.0, 1.0, -1.0)));
  EXPECT_LT(turn_off(fit), 1.0 * geometry::kDegree);
  EXPECT_LT(shift_off(fit), 0.12);  // an eighth of a voxel
  EXPECT_GT(fit.correlation, 0.95);
}

TEST_F(ImageRegistration, ObliqueThickSlicesOfBothImagesServe) {
  const Quat oblique(Eigen::AngleAxisd(25.0 * geometry::kDegree, Vec3(1.0, 1.0, 0.3).normalized()));
  const BoneImage bone = reference({.spacing = Vec3(0.6, 0.6, 1.8), .seed = 7});
  const ImageLevels other = blurred_levels(
      image_of(truth(), {.spacing = Vec3(0.9, 0.7, 1.5), .turn = oblique, .seed = 8}));
  const ImageFit fit = bone.fit(other, near_truth(6.0 * geometry::kDegree, Vec3(1.0, 1.0, -1.0)));
  // The blur of a slice lies otherwise in the bone then: a fifth of a voxel.
  EXPECT_LT(turn_off(fit), 1.5 * geometry::kDegree);
  EXPECT_LT(shift_off(fit), 0.2);
}

TEST_F(ImageRegistration, ABoneFarFromItsStartIsFoundByTrying) {
  const BoneImage bone = reference({.seed = 9});
  const ImageLevels other = blurred_levels(image_of(truth(), {.seed = 10}));
  std::vector<geometry::Rigid3> starts;
  const Vec3 end(-16.0, 0.0, 0.0);  // stays: a joint
  for (int k = -9; k <= 9; ++k) {
    for (int n = -9; n <= 9; ++n) {
      const Quat turn =
          Quat(Eigen::AngleAxisd(10.0 * k * geometry::kDegree + 0.08, Vec3::UnitZ())) *
          Quat(Eigen::AngleAxisd(10.0 * n * geometry::kDegree + 0.08, Vec3::UnitY()));
      geometry::Rigid3 start;
      start.rotation = truth().rotation * turn;
      start.translation = truth() * end - start.rotation * end + Vec3(0.5, -0.5, 0.5);
      starts.push_back(start);
    }
  }
  const ImageFit fit = bone.find(other, starts);
  EXPECT_LT(turn_off(fit), 1.0 * geometry::kDegree);
  EXPECT_LT(shift_off(fit), 0.12);  // an eighth of a voxel
  EXPECT_EQ(fit.fixed_from_moving.translation,
            bone.find(other, starts).fixed_from_moving.translation);
}

TEST_F(ImageRegistration, WhatIsNoBoneDoesntLookAlike) {
  const BoneImage bone = reference({.seed = 11});
  half_ = Vec3(0.01, 0.01, 0.01);
  knob_ = 0.0;
  const ImageLevels empty = blurred_levels(image_of(truth(), {.seed = 12}));
  EXPECT_LT(bone.fit(empty, truth()).correlation, 0.5);
}

TEST_F(ImageRegistration, ATurnThatTheShapeDoesntHoldIsSaid) {
  half_ = Vec3(16.0, 5.0, 5.0);
  knob_ = 0.0;
  const BoneImage bone = reference({.seed = 13});
  const ImageLevels other = blurred_levels(image_of(truth(), {.seed = 14}));
  const ImageFit fit = bone.fit(other, truth());
  EXPECT_GT(fit.turn_error, 5.0 * geometry::kDegree);
  const Vec3 along = fit.fixed_from_moving.rotation * Vec3::UnitX();
  const Vec3 wanted = truth().rotation * Vec3::UnitX();
  EXPECT_LT(along.cross(wanted).norm(), 1.0 * geometry::kDegree);
  EXPECT_LT(shift_off(fit), 0.1);
}

TEST_F(ImageRegistration, WhatLiesOutsideTheImageIsLeftOut) {
  const BoneImage bone = reference({.seed = 15});
  imaging::Volume image = image_of(truth(), {.seed = 16});
  image.grid.size[2] = image.grid.size[2] / 2 + 4;
  image.value.resize(image.grid.count());
  const ImageFit fit =
      bone.fit(blurred_levels(image), near_truth(4.0 * geometry::kDegree, Vec3(1.0, 0.0, 0.0)));
  EXPECT_LT(fit.overlap, 0.9);
  EXPECT_LT(turn_off(fit), 2.0 * geometry::kDegree);
  geometry::Rigid3 away = truth();
  away.translation.x() += 500.0;
  const ImageFit none = bone.fit(blurred_levels(image), away);
  EXPECT_EQ(none.overlap, 0.0);
  EXPECT_EQ(none.correlation, 0.0);
  EXPECT_FALSE(none.has_converged);
  EXPECT_FALSE(std::isfinite(none.turn_error));
}

TEST_F(ImageRegistration, WrongUseIsNamed) {
  const ImageLevels levels = blurred_levels(image_of({}, {}));
  const auto message = [](const auto& call) -> std::string {
    try {
      call();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  geometry::TriangleMesh away = bone_mesh();
  for (Vec3& v : away.vertices) v.x() += 200.0;
  EXPECT_THAT(message([&] { BoneImage(away, levels); }), HasSubstr("0 voxels are in it; 30"));
  EXPECT_THAT(message([&] { BoneImage(bone_mesh(), levels, {.layer = -1.0}); }),
              HasSubstr("layer is -1; 0 to 5 mm is required"));
  EXPECT_THAT(message([&] { BoneImage(bone_mesh(), levels).find(levels, {}); }),
              HasSubstr("no start"));
  ScanSurfaces surfaces;
  surfaces.bones = {{"capitate", bone_mesh()}, {"hamate", away}, {"", bone_mesh()}};
  const BoneImages images = images_of_bones(surfaces, levels);
  EXPECT_EQ(images.size(), 1U);
  EXPECT_TRUE(images.contains("capitate"));
}

}  // namespace
}  // namespace palmar::capture
