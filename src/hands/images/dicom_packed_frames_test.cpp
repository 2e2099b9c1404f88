// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Multi-frame files whose pixels follow a formula and that GDCM packs and writes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hands/images/dicom.h"
#include "hands/images/gdcm_test_files.h"
#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/test_files.h"

namespace palmar::images {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Every voxel has the formula's value at the formula's place: i along (0, 1, 0), j along (0, 0,
/// -1), k along their normal (-1, 0, 0).
void expect_formula(const imaging::Volume& image, const std::string& what) {
  ASSERT_EQ(image.grid.size, (std::array<int, 3>{37, 29, 5})) << what;
  for (int k = 0; k < 5; ++k) {
    const Vec3 place(-10 - 1.5 * k, 20 + 0.25 * 36, 5 - 0.5 * 28);  // of the last pixel, mm
    EXPECT_LT((image.grid.to_patient(Vec3(36, 28, k)) - place).norm(), 1e-9) << what;
    for (int j = 0; j < 29; ++j) {
      for (int i = 0; i < 37; ++i) {
        ASSERT_EQ(image.value[image.grid.at(i, j, k)],
                  2.0F * static_cast<float>(formula_value(i, j, k)) + 1.0F)
            << what << " " << i << " " << j << " " << k;
      }
    }
  }
}

TEST(DicomPackedFrames, EnhancedFilesOfAnotherProgramReadExactly) {
  auto ways = packed_syntaxes();
  ways.emplace_back("explicit", gdcm::TransferSyntax::ExplicitVRLittleEndian);
  for (const auto& [name, syntax] : ways) {
    const formats::TestFolder folder;
    GdcmImage image;
    image.syntax = syntax;
    image.write(folder / "s/one.dcm");
    const ImageFile file = read_image(folder / "s/one.dcm");
    expect_formula(file.image, name);
    EXPECT_THAT(file.notes, IsEmpty()) << name;
    EXPECT_EQ(file.description, "reference");
    EXPECT_EQ(read_image(folder / "s").image.value, file.image.value) << name;
    EXPECT_EQ(find_dicom_series(folder / "s/one.dcm").at(0).slices, 5) << name;
  }
}

TEST(DicomPackedFrames, OldStyleFilesReadByOffsetsAndBySpacing) {
  auto ways = packed_syntaxes();
  ways.emplace_back("explicit", gdcm::TransferSyntax::ExplicitVRLittleEndian);
  for (const auto& [name, syntax] : ways) {
    const formats::TestFolder folder;
    GdcmImage image;
    image.syntax = syntax;
    image.write(folder / "offsets.dcm");
    image.write(folder / "spacing.dcm");
    std::vector<std::pair<std::uint32_t, std::string>> place = {
        {0x00200032, "-10\\20\\5"}, {0x00200037, "0\\1\\0\\0\\0\\-1"},
        {0x00280030, "0.5\\0.25"},  {0x00281052, "1"},
        {0x00281053, "2"},          {0x3004000C, ""}};
    place.back() = {0x3004000C, "0\\1.5\\3\\4.5\\6"};
    make_old_style(folder / "offsets.dcm", place);
    place.back() = {0x00180088, "1.5"};
    make_old_style(folder / "spacing.dcm", place);
    const ImageFile by_offsets = read_image(folder / "offsets.dcm");
    expect_formula(by_offsets.image, name + " by offsets");
    EXPECT_THAT(by_offsets.notes, IsEmpty());
    const ImageFile by_spacing = read_image(folder / "spacing.dcm");
    expect_formula(by_spacing.image, name + " by spacing");
    EXPECT_EQ(by_spacing.notes.size(), 1U);
  }
}

TEST(DicomPackedFrames, AFrameThatIsMissingOrSpoiltIsNamed) {
  const formats::TestFolder folder;
  GdcmImage image;
  image.syntax = gdcm::TransferSyntax::JPEGLSLossless;
  image.write(folder / "one.dcm");
  const std::string whole = formats::read_file(folder / "one.dcm");
  const auto message_with = [&](const std::string& bytes) {
    formats::write_file(folder / "one.dcm", bytes);
    return formats::message_of<InputError>([&] { read_image(folder / "one.dcm"); });
  };
  // The third stream says it has 36 columns.
  std::size_t stream = 0;
  for (int k = 0; k < 3; ++k) stream = whole.find("\xFF\xD8\xFF\xF7", stream + 1);
  std::string bytes = whole;
  bytes.at(stream + 10) = 36;
  EXPECT_THAT(message_with(bytes),
              HasSubstr("one.dcm (frame 3): its compressed image has 36 x 29 pixels; the file says "
                        "37 x 29"));
  EXPECT_THAT(message_with(whole.substr(0, stream)),
              AllOf(HasSubstr("one.dcm: byte "), HasSubstr("the compressed pixels are cut off")));
  // One frame fewer than the file says: the last fragment goes, the delimiter stays.
  for (int k = 0; k < 2; ++k) stream = whole.find("\xFF\xD8\xFF\xF7", stream + 1);
  EXPECT_THAT(message_with(whole.substr(0, stream - 8) + whole.substr(whole.size() - 8)),
              HasSubstr("one.dcm: 4 compressed pieces of 5 frames, without a table"));
}

}  // namespace
}  // namespace palmar::images
