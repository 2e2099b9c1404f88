// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/handle_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"

namespace palmar::records {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

std::filesystem::path written(const std::string& text) {
  const auto path = std::filesystem::path(::testing::TempDir()) / "handle_file_test.toml";
  formats::write_file(path, text);
  return path;
}

TEST(HandleFile, ReadsBackWhatWasWritten) {
  redesign::HandleShape shape;
  shape.features.width = 34.2;
  shape.features.depth = 41.5;
  shape.features.egg = -0.12;
  shape.features.twist = 0.1;  // rad per 100 mm
  shape.end_radius = 3.0;
  shape.kept_ends = {8.0, 12.5};
  shape.kept_faces = {"tang", "7"};
  shape.kept_boxes = {Box3(Vec3(-9, -8, -7), Vec3(1, 2, 3.5)),
                      Box3(Vec3(0, 0, 40), Vec3(5, 5, 65))};
  const HandleFile file = read_handle(written(handle_toml(shape, "a \"prism\"")));
  for (const redesign::HandleFeature& one : redesign::handle_features()) {
    EXPECT_NEAR(one.scale * file.features.*one.value, one.scale * shape.features.*one.value, 5.1e-4)
        << one.name;
  }
  EXPECT_EQ(file.end_radius, 3.0);
  EXPECT_EQ(file.kept_ends, shape.kept_ends);
  EXPECT_EQ(file.kept_faces, shape.kept_faces);
  ASSERT_EQ(file.kept_boxes.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_TRUE(file.kept_boxes[i].isApprox(shape.kept_boxes[i])) << i;
  }
}

TEST(HandleFile, NamesWhatIsWrongWithItsLine) {
  const auto refused = [](const std::string& text, const std::string& message) {
    EXPECT_THAT([&] { read_handle(written(text)); }, ThrowsMessage<InputError>(HasSubstr(message)))
        << text;
  };
  refused("[features]\nwidth_mm = 30\ndepth_mm = 40\n", "version is needed");
  refused("version = 1\n", "features is needed");
  refused("version = 1\n[features]\nwidth_mm = 30\n", "depth_mm");
  refused("version = 1\n[features]\nwidth_mm = 300\ndepth_mm = 40\n", "width_mm");
  refused("version = 1\n[features]\nwidth_mm = 30\ndepth_mm = 40\nswel_mm = 2\n", "swell_mm");
  refused("version = 1\n[features]\nwidth_mm = 30\ndepth_mm = 40\n[ends]\nkept_boxes_mm = [1, 2]\n",
          "kept_boxes_mm has 2 coordinates; six for each box are required");
  refused("version = 1\n[features]\nwidth_mm = 30\ndepth_mm = 40\n[ends]\nkept_mm = [1, 2, 3]\n",
          "kept_mm has 3 lengths; one for the bottom and one for the top");
}

TEST(HandleFile, OneLengthKeptIsThatOfBothEnds) {
  const HandleFile file = read_handle(
      written("version = 1\n[features]\nwidth_mm = 30\ndepth_mm = 40\n[ends]\nkept_mm = 6.5\n"));
  EXPECT_EQ(file.kept_ends, (std::array<double, 2>{6.5, 6.5}));
}

}  // namespace
}  // namespace palmar::records
