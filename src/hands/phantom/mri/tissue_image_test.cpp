// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/phantom/mri/tissue_image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::phantom {
namespace {

constexpr double kPi = std::numbers::pi;

geometry::TriangleMesh moved(geometry::TriangleMesh mesh, const Vec3& by) {
  for (Vec3& v : mesh.vertices) v += by;
  return mesh;
}

imaging::VolumeGrid cube_grid(int size, double spacing) {
  return {.size = {size, size, size},
          .spacing = Vec3::Constant(spacing),
          .axes = Eigen::Matrix3d::Identity(),
          .origin = Vec3::Constant(-0.5 * (size - 1) * spacing)};
}

double sum_of(const imaging::Volume& image) {
  return std::accumulate(image.value.begin(), image.value.end(), 0.0);
}

const ScannerOptions kIdeal{.subsamples = 3, .snr = 0.0, .bias = 0.0, .seed = 1};

TEST(TissueImage, SignalOfASphereIsItsVolumeTimesItsSignal) {
  const geometry::TriangleMesh sphere =
      moved(geometry::make_icosphere(9.0, 4), Vec3(0.3, -0.2, 0.15));
  const imaging::Volume image = image_of({{sphere, 180.0}}, cube_grid(24, 1.0), kIdeal);
  // Rays hold the volume within 0.1 %: 9 per voxel face, errors of both signs at the rim.
  EXPECT_NEAR(sum_of(image) / 180.0, geometry::signed_volume(sphere),
              1e-3 * geometry::signed_volume(sphere));
  EXPECT_FLOAT_EQ(image.value[image.grid.at(12, 12, 12)], 180.0F);
  EXPECT_EQ(image.value[image.grid.at(0, 0, 0)], 0.0F);
}

TEST(TissueImage, ALaterPartCoversAnEarlierOne) {
  const geometry::TriangleMesh outer = geometry::make_icosphere(9.0, 4),
                               inner = geometry::make_icosphere(5.0, 4);
  const imaging::Volume image =
      image_of({{outer, 100.0}, {inner, 40.0}}, cube_grid(24, 1.0), kIdeal);
  const double expected =
      100.0 * (geometry::signed_volume(outer) - geometry::signed_volume(inner)) +
      40.0 * geometry::signed_volume(inner);
  EXPECT_NEAR(sum_of(image), expected, 1e-3 * expected);
  EXPECT_FLOAT_EQ(image.value[image.grid.at(12, 12, 12)], 40.0F);
  // The order is what counts: an inner part listed first is hidden.
  const imaging::Volume hidden =
      image_of({{inner, 40.0}, {outer, 100.0}}, cube_grid(24, 1.0), kIdeal);
  EXPECT_FLOAT_EQ(hidden.value[hidden.grid.at(12, 12, 12)], 100.0F);
}

TEST(TissueImage, AVoxelHoldsTheShareThatIsCovered) {
  // A box from -4 to 4.5: the voxel centred at 4 is covered from 3.5 to 4.5 wholly, that at -4
  // half.
  const geometry::TriangleMesh box =
      moved(geometry::make_box(Vec3(8.5, 8.0, 8.0)), Vec3(0.25, 0.0, 0.0));
  imaging::VolumeGrid grid{.size = {16, 16, 16}, .origin = Vec3::Constant(-8.0)};
  const imaging::Volume image = image_of({{box, 200.0}}, grid, kIdeal);
  EXPECT_NEAR(image.value[grid.at(12, 8, 8)], 200.0, 1e-4);
  EXPECT_NEAR(image.value[grid.at(4, 8, 8)], 100.0, 1e-4);
  EXPECT_NEAR(image.value[grid.at(13, 8, 8)], 0.0, 1e-4);
  // Across the rays the share comes in steps of a third: half a voxel is 1/3 or 2/3.
  EXPECT_NEAR(image.value[grid.at(8, 4, 8)], 100.0, 200.0 / 6.0 + 1e-4);
}

TEST(TissueImage, AxesOfTheGridDontChangeTheSubject) {
  // The same sphere seen by an oblique, left-handed, anisotropic grid.
  const geometry::TriangleMesh sphere =
      moved(geometry::make_icosphere(8.0, 4), Vec3(50.0, -20.0, 7.0));
  imaging::VolumeGrid grid{.size = {40, 28, 26}, .spacing = Vec3(0.6, 0.8, 1.1)};
  grid.axes = Eigen::AngleAxisd(0.4, Vec3(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
  grid.axes.col(2) *= -1.0;
  grid.origin = Vec3(50.0, -20.0, 7.0) - grid.axes * Vec3(11.7, 10.8, 13.75);
  const imaging::Volume image = image_of({{sphere, 150.0}}, grid, kIdeal);
  const double voxel = 0.6 * 0.8 * 1.1;
  EXPECT_NEAR(sum_of(image) * voxel / 150.0, geometry::signed_volume(sphere),
              2e-3 * geometry::signed_volume(sphere));
}

TEST(TissueImage, FatLiesOffAlongTheRows) {
  // A box of fat from -4 to 4.5, shifted by 1.5 mm: -2.5 to 6. Water beside it stays; where they
  // overlap signals add.
  const geometry::TriangleMesh fat =
      moved(geometry::make_box(Vec3(8.5, 8.0, 8.0)), Vec3(0.25, 0.0, 0.0));
  const geometry::TriangleMesh water =
      moved(geometry::make_box(Vec3(3.0, 8.0, 8.0)), Vec3(6.0, 0.0, 0.0));
  imaging::VolumeGrid grid{.size = {16, 16, 16}, .origin = Vec3::Constant(-8.0)};
  ScannerOptions options = kIdeal;
  options.fat_shift = 1.5;
  const imaging::Volume image =
      image_of({{fat, 200.0, ImagedTissue::kFat}, {water, 80.0}}, grid, options);
  const auto at = [&](int x) { return image.value[grid.at(x + 8, 8, 8)]; };
  EXPECT_NEAR(at(-3), 0.0, 1e-4);
  EXPECT_NEAR(at(-2), 200.0, 1e-4);
  EXPECT_NEAR(at(4), 200.0, 1e-4);
  EXPECT_NEAR(at(5), 280.0, 1e-4);  // 4.5 to 5.5: both
  EXPECT_NEAR(at(6), 0.5 * 200 + 80.0, 1e-4);
  EXPECT_NEAR(at(7), 80.0, 1e-4);
}

TEST(TissueImage, EdgesRingWhereFewFrequenciesAreAcquired) {
  // A step to 100: the ideal low pass overshoots by 8.95 of 100 (Wilbraham 1848, Gibbs 1899); a
  // voxel's own width and sampling take a little of that. The mean stays.
  const geometry::TriangleMesh half =
      moved(geometry::make_box(Vec3(60.0, 200.0, 200.0)), Vec3(30.0, 0.0, 0.0));
  imaging::VolumeGrid grid{.size = {120, 60, 1}, .origin = Vec3(-60.0, -30.0, 0.0)};
  ScannerOptions options = kIdeal;
  options.acquired = 0.5;
  const imaging::Volume image = image_of({{half, 100.0}}, grid, options);
  double most = 0.0, sum = 0.0;
  for (int i = 60; i < 90; ++i) most = std::max<double>(most, image.value[grid.at(i, 30, 0)]);
  for (int i = 80; i < 92; ++i) sum += image.value[grid.at(i, 30, 0)] / 12.0;
  EXPECT_GT(most, 105.0);
  EXPECT_LT(most, 109.5);
  EXPECT_NEAR(sum, 100.0, 1.5);
}

TEST(TissueImage, MarrowIsAsUnevenAsAsked) {
  ScannerOptions options = kIdeal;
  options.marrow_texture = 0.1;
  const imaging::VolumeGrid grid = cube_grid(24, 1.0);
  const imaging::Volume image =
      image_of({{geometry::make_icosphere(11.0, 4), 100.0},
                {geometry::make_icosphere(9.0, 4), 180.0, ImagedTissue::kMarrow}},
               grid, options);
  double sum = 0.0, squares = 0.0, count = 0.0;
  for (int k = 8; k < 16; ++k) {
    for (int j = 8; j < 16; ++j) {
      for (int i = 8; i < 16; ++i) {
        const double value = image.value[grid.at(i, j, k)] / 180.0;
        sum += value;
        squares += value * value;
        count += 1.0;
      }
    }
  }
  const double mean = sum / count;
  EXPECT_NEAR(mean, 1.0, 0.02);
  EXPECT_NEAR(std::sqrt(squares / count - mean * mean), 0.1, 0.02);
  EXPECT_FLOAT_EQ(image.value[grid.at(12, 12, 2)], 100.0F);  // other tissue is even
}

TEST(TissueImage, AMaskedBackgroundIsZero) {
  ScannerOptions options = kIdeal;
  options.snr = 20.0;
  options.mask = 5.0;
  const imaging::VolumeGrid grid = cube_grid(24, 1.0);
  const imaging::Volume image =
      image_of({{geometry::make_icosphere(9.0, 4), 180.0}}, grid, options);
  // P(noise of air > 5 deviations) = exp(-12.5).
  EXPECT_EQ(image.value[grid.at(1, 1, 1)], 0.0F);
  EXPECT_EQ(image.value[grid.at(22, 3, 20)], 0.0F);
  EXPECT_NEAR(image.value[grid.at(12, 12, 12)], 180.0, 5.0 * 9.0);
}

TEST(TissueImage, NoiseOfAirIsRayleighsAndOfTissueRicians) {
  // Air: mean sqrt(pi/2) sigma, variance (2 - pi/2) sigma^2. At high signal S: mean S + sigma^2 /
  // (2 S), variance sigma^2 (Gudbjartsson, Patz 1995, eq. 2 and 3).
  imaging::VolumeGrid grid{.size = {80, 40, 40}, .origin = Vec3(-40.0, -20.0, -20.0)};
  const geometry::TriangleMesh half =
      moved(geometry::make_box(Vec3(40.5, 100.0, 100.0)), Vec3(20.25 - 0.5, 0.0, 0.0));
  const double sigma = 200.0 / 25.0;
  const imaging::Volume image =
      image_of({{half, 200.0}}, grid, {.subsamples = 1, .snr = 25.0, .bias = 0.0});
  double air = 0.0, air2 = 0.0, tissue = 0.0, tissue2 = 0.0;
  const double count = 40 * 40 * 40.0;
  for (int k = 0; k < 40; ++k) {
    for (int j = 0; j < 40; ++j) {
      for (int i = 0; i < 80; ++i) {
        const double v = image.value[grid.at(i, j, k)];
        (i < 40 ? air : tissue) += v / count;
        (i < 40 ? air2 : tissue2) += v * v / count;
      }
    }
  }
  const double spread = sigma / std::sqrt(count);  // of a mean
  EXPECT_NEAR(air, std::sqrt(kPi / 2.0) * sigma, 4.0 * spread);
  EXPECT_NEAR(air2 - air * air, (2.0 - kPi / 2.0) * sigma * sigma, 0.02 * sigma * sigma);
  EXPECT_NEAR(tissue, 200.0 + sigma * sigma / 400.0, 4.0 * spread);
  EXPECT_NEAR(tissue2 - tissue * tissue, sigma * sigma, 0.03 * sigma * sigma);
}

TEST(TissueImage, FieldFallsSmoothlyByTheShareAsked) {
  const imaging::VolumeGrid grid = cube_grid(30, 2.0);
  const geometry::TriangleMesh all = geometry::make_box(Vec3::Constant(100.0));
  const imaging::Volume image =
      image_of({{all, 100.0}}, grid, {.subsamples = 1, .snr = 0.0, .bias = 0.4});
  const auto [low, high] = std::minmax_element(image.value.begin(), image.value.end());
  EXPECT_GE(*low, 60.0F - 1e-3F);
  EXPECT_LE(*high, 100.0F + 1e-3F);
  EXPECT_GT(*high - *low, 20.0F);
  for (int k = 0; k < 30; ++k) {
    for (int i = 1; i < 30; ++i) {
      EXPECT_NEAR(image.value[grid.at(i, 7, k)], image.value[grid.at(i - 1, 7, k)], 3.0);
    }
  }
}

TEST(TissueImage, SameBytesWithOneThreadAndFourAnotherSeedOthers) {
  const std::vector<ImagedPart> parts{{geometry::make_icosphere(9.0, 3), 100.0}};
  const imaging::VolumeGrid grid = cube_grid(20, 1.0);
  const int before = thread_count();
  set_thread_count(1);
  const imaging::Volume one = image_of(parts, grid, {.seed = 5});
  set_thread_count(4);
  const imaging::Volume four = image_of(parts, grid, {.seed = 5});
  set_thread_count(before);
  EXPECT_EQ(one.value, four.value);
  EXPECT_NE(one.value, image_of(parts, grid, {.seed = 6}).value);
}

TEST(TissueImage, RefusesOpenAndInsideOutSurfacesAndNamesThePart) {
  geometry::TriangleMesh open = geometry::make_icosphere(5.0, 1), turned = open;
  open.triangles.pop_back();
  for (Triangle& t : turned.triangles) std::swap(t[1], t[2]);
  const geometry::TriangleMesh whole = geometry::make_icosphere(5.0, 1);
  try {
    image_of({{whole, 1.0}, {open, 2.0}}, cube_grid(8, 2.0));
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("part 2 of 2"));
    EXPECT_THAT(e.what(), testing::HasSubstr("closed"));
  }
  EXPECT_THROW(image_of({{turned, 1.0}}, cube_grid(8, 2.0)), InputError);
  EXPECT_THROW(image_of({{whole, 1.0}}, cube_grid(0, 2.0)), UsageError);
  EXPECT_THROW(image_of({{whole, 1.0}}, cube_grid(8, 2.0), {.snr = 0.5}), UsageError);
}

}  // namespace
}  // namespace palmar::phantom
