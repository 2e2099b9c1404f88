// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/hand/mri_steps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"
#include "palmar/formats/test_files.h"

namespace palmar {
namespace {

using ::testing::HasSubstr;

/// 4 x 4 x 4 voxels of 1 x 1 x 2 mm; intensities 0 to 63, i fastest.
std::string small_image(const TestFolder& folder) {
  Volume image;
  image.grid.size = {4, 4, 4};
  image.grid.spacing = {1.0, 1.0, 2.0};
  for (int v = 0; v < 64; ++v) image.value.push_back(static_cast<float>(v));
  const std::string path = (folder / "small.nii").string();
  write_image(path, image);
  return path;
}

TEST(DescribeMriImage, ReportsExtentOfIntensitiesAndItsMiddle) {
  const TestFolder folder;
  const MriImageInfo info = describe_mri_image(small_image(folder));
  EXPECT_EQ(info.least, 0.0F);
  EXPECT_EQ(info.most, 63.0F);
  const VolumeGrid& grid = info.file.image.grid;
  // Half way between the first voxel and the last.
  const Vec3 middle = 0.5 * (grid.to_patient(Vec3(0, 0, 0)) + grid.to_patient(Vec3(3, 3, 3)));
  EXPECT_LT((info.centre - middle).norm(), 1e-9);  // mm; rounding
}

TEST(MriSurfacesRequest, NamesWhatIsMissing) {
  MriSurfacesRequest request;
  EXPECT_THAT(message_of<UsageError>([&] { request.check(); }), HasSubstr("setting \"image\""));
  request.image = "scans/reference";
  EXPECT_THAT(message_of<UsageError>([&] { request.check(); }), HasSubstr("setting \"out\""));
  request.out = "reference";
  EXPECT_EQ(message_of<UsageError>([&] { request.check(); }), "");
}

TEST(FindBoneMotions, SurfacesThatAreNotThereAreNamed) {
  BoneMotionRequest request;
  EXPECT_THAT(message_of<UsageError>([&] { find_bone_motions(request); }),
              HasSubstr("setting \"reference\""));
  request.reference = "nowhere/reference";
  request.posture = "nowhere/grasp";
  EXPECT_THAT(message_of<InputError>([&] { find_bone_motions(request); }),
              HasSubstr("nowhere/reference"));
}

}  // namespace
}  // namespace palmar
