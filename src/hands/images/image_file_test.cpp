// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <fstream>
#include <random>

#include "hands/images/dicom.h"
#include "hands/images/image_formats.h"
#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/test_files.h"

namespace palmar::images {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Puts a value into a header at an offset of nifti1.h.
template <typename T>
void put(std::string& bytes, std::size_t offset, T value, std::endian order) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
  std::copy(raw.begin(), raw.end(), bytes.begin() + static_cast<std::ptrdiff_t>(offset));
}

/// A NIfTI-1 file of 2 x 1 x 2 voxels of 16 bits: 10, 20, 30, 40.
std::string nifti_file(std::endian order = std::endian::little) {
  std::string bytes(352 + 8, '\0');
  put(bytes, 0, std::int32_t{348}, order);
  const std::int16_t dim[] = {3, 2, 1, 2, 1, 1, 1, 1};
  for (std::size_t d = 0; d < 8; ++d) put(bytes, 40 + 2 * d, dim[d], order);
  put(bytes, 70, std::int16_t{4}, order);   // int16
  put(bytes, 72, std::int16_t{16}, order);  // bits
  const float step[] = {1.0F, 2.0F, 3.0F, 4.0F};
  for (std::size_t d = 0; d < 4; ++d) put(bytes, 76 + 4 * d, step[d], order);
  put(bytes, 108, 352.0F, order);
  put(bytes, 123, std::uint8_t{2}, order);  // mm
  bytes.replace(344, 4, std::string("n+1\0", 4));
  for (std::size_t v = 0; v < 4; ++v) {
    put(bytes, 352 + 2 * v, static_cast<std::int16_t>(10 * (v + 1)), order);
  }
  return bytes;
}

void put_sform(std::string& bytes, const std::array<float, 12>& rows,
               std::endian order = std::endian::little) {
  put(bytes, 254, std::int16_t{1}, order);
  for (std::size_t n = 0; n < 12; ++n) put(bytes, 280 + 4 * n, rows[n], order);
}

TEST(Nifti, RightAndFrontBecomeLeftAndBack) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    // i steps 2 mm to the right, j 3 mm to the head, k 4 mm to the front; NIfTI counts right, front
    // and head as positive, DICOM left, back and head.
    std::string bytes = nifti_file(order);
    put_sform(bytes, {2, 0, 0, 10, 0, 0, 4, 20, 0, 3, 0, 30}, order);
    const ImageFile file = read_nifti(bytes, "a.nii");
    const imaging::VolumeGrid& grid = file.image.grid;
    EXPECT_LT((grid.spacing - Vec3(2, 3, 4)).norm(), 1e-9);
    EXPECT_LT((grid.to_patient(Vec3(0, 0, 0)) - Vec3(-10, -20, 30)).norm(), 1e-6);
    EXPECT_LT((grid.to_patient(Vec3(1, 0, 0)) - Vec3(-12, -20, 30)).norm(), 1e-6);
    EXPECT_LT((grid.to_patient(Vec3(0, 1, 0)) - Vec3(-10, -20, 33)).norm(), 1e-6);
    EXPECT_LT((grid.to_patient(Vec3(0, 0, 1)) - Vec3(-10, -24, 30)).norm(), 1e-6);
    EXPECT_THAT(file.image.value, ElementsAre(10.0F, 20.0F, 30.0F, 40.0F));
    EXPECT_THAT(file.notes, IsEmpty());
  }
}

TEST(Nifti, QuaternionAndItsFlippedThirdAxisCount) {
  // Half a turn about z: (b, c, d) = (0, 0, 1), so i points left and j back, as in DICOM.
  std::string bytes = nifti_file();
  put(bytes, 252, std::int16_t{1}, std::endian::little);
  put(bytes, 264, 1.0F, std::endian::little);
  put(bytes, 268, -5.0F, std::endian::little);
  EXPECT_LT((read_nifti(bytes, "q").image.grid.to_patient(Vec3(1, 1, 1)) - Vec3(7, 3, 4)).norm(),
            1e-6);
  put(bytes, 76, -1.0F, std::endian::little);  // qfac: k the other way
  EXPECT_LT((read_nifti(bytes, "q").image.grid.to_patient(Vec3(1, 1, 1)) - Vec3(7, 3, -4)).norm(),
            1e-6);
}

TEST(Nifti, ValuesAreScaledAndUnitsConverted) {
  std::string bytes = nifti_file();
  put_sform(bytes, {0.002F, 0, 0, 0, 0, 0.003F, 0, 0, 0, 0, 0.004F, 0});
  put(bytes, 123, std::uint8_t{1}, std::endian::little);  // metres
  put(bytes, 112, 0.5F, std::endian::little);
  put(bytes, 116, -1.0F, std::endian::little);
  const ImageFile file = read_nifti(bytes, "m.nii");
  EXPECT_LT((file.image.grid.spacing - Vec3(2, 3, 4)).norm(), 1e-5);
  EXPECT_THAT(file.image.value, ElementsAre(4.0F, 9.0F, 14.0F, 19.0F));
}

TEST(Nifti, DamageIsNamed) {
  const auto message = [](const std::string& bytes) {
    return formats::message_of<InputError>([&] { read_nifti(bytes, "a.nii"); });
  };
  const auto changed = [](std::size_t offset, auto value) {
    std::string bytes = nifti_file();
    put(bytes, offset, value, std::endian::little);
    return bytes;
  };
  EXPECT_THAT(message(nifti_file().substr(0, 355)),
              HasSubstr("a.nii: is cut off: 2 x 1 x 2 voxels need 8 bytes, 3 are there"));
  EXPECT_THAT(message(nifti_file().substr(0, 300)), HasSubstr("a.nii: is no NIfTI-1 image"));
  EXPECT_THAT(message(changed(40, std::int16_t{2})), HasSubstr("2 dimensions; 3 are required"));
  EXPECT_THAT(message(changed(70, std::int16_t{128})), HasSubstr("is a colour image"));
  EXPECT_THAT(message(changed(70, std::int16_t{32})), HasSubstr("NIfTI type 32 aren't read"));
  EXPECT_THAT(message(changed(80, 0.0F)), HasSubstr("voxels are 0 mm apart along i"));
  EXPECT_THAT(message(changed(42, std::int16_t{-2})), HasSubstr("has -2 x 1 x 2 voxels"));
  std::string large = nifti_file();
  for (std::size_t d = 1; d <= 3; ++d) {
    put(large, 40 + 2 * d, std::int16_t{32767}, std::endian::little);
  }
  EXPECT_THAT(message(large), HasSubstr("up to 2.1 GB are read"));
  std::string series = changed(40, std::int16_t{4});
  put(series, 48, std::int16_t{5}, std::endian::little);
  EXPECT_THAT(message(series), HasSubstr("holds 5 images in dimension 4; one is required"));
  std::string sheared = nifti_file();
  put_sform(sheared, {2, 1, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0});
  EXPECT_THAT(message(sheared), HasSubstr("axes aren't square, by 18.43 degrees"));  // atan 1/3
  std::string real = changed(70, std::int16_t{16});
  real.resize(352 + 16, '\0');
  put(real, 352 + 8, std::nanf(""), std::endian::little);
  put(real, 352 + 4, 1.0F, std::endian::little);
  EXPECT_THAT(message(real), HasSubstr("the value of voxel (0, 0, 1) is nan"));
}

TEST(ImageFile, ImagesReadBackFromEveryFormat) {
  const formats::TestFolder folder;
  imaging::Volume image;
  image.grid.size = {5, 4, 3};
  image.grid.spacing = Vec3(0.5, 0.75, 2.0);
  image.grid.axes = Eigen::AngleAxisd(2.5, Vec3(3, -2, 1).normalized()).toRotationMatrix();
  image.grid.axes.col(2) *= -1.0;
  image.grid.origin = Vec3(12.5, -40.25, 7.75);
  for (int v = 0; v < 60; ++v) image.value.push_back(0.1F * static_cast<float>(v) - 2.0F);
  for (const char* const name : {"a.nii", "a.nii.gz"}) {
    write_image(folder / name, image);
    const imaging::Volume read = read_image(folder / name).image;
    EXPECT_EQ(read.value, image.value) << name;
    const Vec3 corner(4, 3, 2);
    // Single precision in NIfTI: 1e-7 of 40 mm.
    EXPECT_LT((read.grid.to_patient(corner) - image.grid.to_patient(corner)).norm(), 2e-5) << name;
  }
  // Without the matrix, the quaternion says the same.
  std::string bytes = formats::read_file(folder / "a.nii");
  put(bytes, 254, std::int16_t{0}, std::endian::little);
  const imaging::VolumeGrid grid = read_nifti(bytes, "q").image.grid;
  EXPECT_LT((grid.to_patient(Vec3(4, 3, 2)) - image.grid.to_patient(Vec3(4, 3, 2))).norm(), 2e-5);
  EXPECT_THAT(formats::message_of<OutputError>([&] { write_image(folder / "a.png", image); }),
              HasSubstr("a.png: ends in neither .nii nor .nii.gz"));
  std::ofstream(folder / "b.png") << "PNG";
  EXPECT_THAT(
      formats::message_of<InputError>([&] { read_image(folder / "b.png"); }),
      HasSubstr(
          "b.png: is neither DICOM (a folder of files, or a file of several frames) nor NIfTI"));
}

TEST(ImageFile, FuzzedFilesAreReadOrRefusedByName) {
  const formats::TestFolder folder;
  std::string sform = nifti_file();
  put_sform(sform, {2, 0, 0, 10, 0, 0, 4, 20, 0, 3, 0, 30});
  const std::string whole[] = {sform, gzip(sform)};
  std::mt19937 random(11);
  const auto any = [&](std::size_t below) { return static_cast<std::size_t>(random()) % below; };
  for (int n = 0; n < 600; ++n) {
    std::string bytes = whole[n % 2];
    for (std::size_t m = 0; m < 1 + any(3); ++m) {
      bytes[any(bytes.size())] = static_cast<char>(any(256));
    }
    if (n % 5 == 0) bytes.resize(1 + any(bytes.size() - 1));
    std::ofstream(folder / "f", std::ios::binary) << bytes;
    try {
      EXPECT_GE(read_image(folder / "f").image.value.size(), 1U);
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("/f"));
    }
  }
}

}  // namespace
}  // namespace palmar::images
