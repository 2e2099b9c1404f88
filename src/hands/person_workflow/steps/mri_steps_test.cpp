// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_workflow/steps/mri_steps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "palmar/core/error.h"
#include "palmar/core/random.h"
#include "palmar/formats/test_files.h"

namespace palmar::person_workflow {
namespace {

using ::testing::HasSubstr;

/// 4 x 4 x 4 voxels of 1 x 1 x 2 mm; intensities 0 to 63, i fastest.
std::string small_image(const formats::TestFolder& folder) {
  imaging::Volume image;
  image.grid.size = {4, 4, 4};
  image.grid.spacing = {1.0, 1.0, 2.0};
  for (int v = 0; v < 64; ++v) image.value.push_back(static_cast<float>(v));
  const std::string path = (folder / "small.nii").string();
  images::write_image(path, image);
  return path;
}

TEST(DescribeMriImage, ReportsExtentOfIntensitiesAndItsMiddle) {
  const formats::TestFolder folder;
  const MriImageInfo info = describe_mri_image(small_image(folder));
  EXPECT_EQ(info.least, 0.0F);
  EXPECT_EQ(info.most, 63.0F);
  const imaging::VolumeGrid& grid = info.file.image.grid;
  // Half way between the first voxel and the last.
  const Vec3 middle = 0.5 * (grid.to_patient(Vec3(0, 0, 0)) + grid.to_patient(Vec3(3, 3, 3)));
  EXPECT_LT((info.centre - middle).norm(), 1e-9);  // mm; rounding
}

TEST(DescribeMriImage, NoHandNoNoise) {
  const formats::TestFolder folder;
  const MriImageInfo info = describe_mri_image(small_image(folder));
  EXPECT_FALSE(info.noise.has_value());
  EXPECT_FALSE(info.air_threshold.has_value());
  EXPECT_THAT(info.no_hand, HasSubstr("no hand in the image"));
}

TEST(DescribeMriImage, NoiseIsTheScannersHoweverTissueIsTextured) {
  // A hand's worth of tissue, half of it bright, of a signal that differs by +-90 from voxel to
  // voxel; magnitude of a signal with noise of 26 in each channel (Gudbjartsson, Patz 1995).
  constexpr double kNoise = 26.0;
  imaging::Volume image;
  image.grid.size = {60, 60, 50};
  image.grid.spacing = {1.5, 1.5, 1.5};
  RandomStream random(1, 0);
  for (int k = 0; k < 50; ++k) {
    for (int j = 0; j < 60; ++j) {
      for (int i = 0; i < 60; ++i) {
        const bool is_tissue = i >= 12 && i < 48 && j >= 12 && j < 48 && k >= 10 && k < 40;
        const double signal =
            is_tissue ? (j < 30 ? 900.0 : 500.0) + 90.0 * (2.0 * random.uniform() - 1.0) : 0;
        image.value.push_back(static_cast<float>(
            std::hypot(signal + kNoise * random.normal(), kNoise * random.normal())));
      }
    }
  }
  const formats::TestFolder folder;
  const std::string path = (folder / "hand.nii").string();
  images::write_image(path, image);
  const MriImageInfo info = describe_mri_image(path);
  ASSERT_TRUE(info.noise.has_value()) << info.no_hand;
  EXPECT_NEAR(*info.noise, kNoise, 0.06 * kNoise);
  // Half way from air to what lies below the surface, half of which is bright: 250 to 450.
  EXPECT_GT(*info.air_threshold, 200.0);
  EXPECT_LT(*info.air_threshold, 500.0);
}

TEST(MriSurfacesRequest, NamesWhatIsMissing) {
  MriSurfacesRequest request;
  EXPECT_THAT(formats::message_of<UsageError>([&] { request.check(); }),
              HasSubstr("setting \"image\""));
  request.image = "scans/reference";
  EXPECT_THAT(formats::message_of<UsageError>([&] { request.check(); }),
              HasSubstr("setting \"out\""));
  request.out = "reference";
  EXPECT_EQ(formats::message_of<UsageError>([&] { request.check(); }), "");
}

TEST(FindBoneMotions, SurfacesThatAreNotThereAreNamed) {
  BoneMotionRequest request;
  EXPECT_THAT(formats::message_of<UsageError>([&] { find_bone_motions(request); }),
              HasSubstr("setting \"reference\""));
  request.reference = "nowhere/reference";
  request.posture = "nowhere/grasp";
  EXPECT_THAT(formats::message_of<InputError>([&] { find_bone_motions(request); }),
              HasSubstr("nowhere/reference"));
}

}  // namespace
}  // namespace palmar::person_workflow
