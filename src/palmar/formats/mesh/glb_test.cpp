// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/mesh/glb.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "palmar/core/error.h"

namespace palmar::formats {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::uint32_t word(const std::vector<std::uint8_t>& bytes, std::size_t at) {
  return bytes[at] | bytes[at + 1] << 8 | bytes[at + 2] << 16 |
         static_cast<std::uint32_t>(bytes[at + 3]) << 24;
}

Glb small() {
  Glb glb;
  glb.json["asset"]["version"] = "2.0";
  return glb;
}

std::string glb_message(const std::vector<std::uint8_t>& bytes) {
  try {
    parse_glb(bytes, "a.glb");
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(Glb, HeaderAndChunksAreAsInTheKhronosSpecification) {
  Glb glb = small();
  glb.buffer = {1, 2, 3, 4, 5};
  const std::vector<std::uint8_t> bytes = format_glb(glb);
  // glTF 2.0, section 4.4: magic, version, length; chunk length, type "JSON"; ... type "BIN\0".
  EXPECT_EQ(word(bytes, 0), 0x46546C67U);
  EXPECT_EQ(word(bytes, 4), 2U);
  EXPECT_EQ(word(bytes, 8), bytes.size());
  const std::uint32_t json_length = word(bytes, 12);
  EXPECT_EQ(json_length % 4, 0U);
  EXPECT_EQ(word(bytes, 16), 0x4E4F534AU);
  EXPECT_EQ(word(bytes, 20 + json_length), 8U);  // five bytes, padded
  EXPECT_EQ(word(bytes, 24 + json_length), 0x004E4942U);
}

TEST(Glb, NumbersComeBackAsTheyWereAdded) {
  Glb glb = small();
  const int floats = add_floats(glb, {1.5F, -2.0F, 0.25F, 8.0F, 9.0F, 10.0F}, 3, true);
  const int indices = add_indices(glb, {0, 70000, 2});
  const int bytes = add_bytes(glb, {255, 0, 7, 1}, 4);
  const double exact = 0.1 + std::numeric_limits<double>::epsilon();
  const int doubles = add_doubles(glb, {exact, -1e300});
  const Glb back = parse_glb(format_glb(glb), "a.glb");
  const AccessorData read = read_accessor(back, floats, "a.glb");
  EXPECT_EQ(read.count, 2);
  EXPECT_EQ(read.components, 3);
  EXPECT_THAT(read.value, ElementsAre(1.5, -2.0, 0.25, 8.0, 9.0, 10.0));
  EXPECT_THAT(read_accessor(back, indices, "a.glb").value, ElementsAre(0, 70000, 2));
  EXPECT_THAT(read_accessor(back, bytes, "a.glb").value, ElementsAre(255, 0, 7, 1));
  EXPECT_THAT(read_doubles(back, doubles, 2, "a.glb"), ElementsAre(exact, -1e300));
  const auto& accessor = back.json["accessors"][static_cast<std::size_t>(floats)];
  EXPECT_THAT(accessor["min"], ElementsAre(1.5, -2.0, 0.25));
  EXPECT_THAT(accessor["max"], ElementsAre(8.0, 9.0, 10.0));
}

TEST(Glb, EveryTruncationIsRefusedByName) {
  Glb glb = small();
  add_floats(glb, {1, 2, 3}, 3);
  const std::vector<std::uint8_t> whole = format_glb(glb);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::vector<std::uint8_t> cut(whole.begin(),
                                        whole.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_THAT(glb_message(cut), HasSubstr("a.glb")) << size << " bytes";
  }
}

TEST(Glb, AnotherVersionAndBrokenJsonAreRefused) {
  std::vector<std::uint8_t> bytes = format_glb(small());
  bytes[4] = 1;
  EXPECT_THAT(glb_message(bytes), HasSubstr("version"));
  bytes = format_glb(small());
  bytes[20] = 'x';  // first letter of the JSON
  EXPECT_THAT(glb_message(bytes), HasSubstr("JSON"));
}

TEST(Glb, AnAccessorBeyondItsBufferIsRefused) {
  Glb glb = small();
  const int floats = add_floats(glb, {1, 2, 3}, 3);
  glb.json["accessors"][static_cast<std::size_t>(floats)]["count"] = 2;
  EXPECT_THROW(read_accessor(glb, floats, "a.glb"), InputError);
  glb.json["accessors"][static_cast<std::size_t>(floats)]["count"] = -1;
  EXPECT_THROW(read_accessor(glb, floats, "a.glb"), InputError);
  EXPECT_THROW(read_accessor(glb, 7, "a.glb"), InputError);
  EXPECT_THROW(read_doubles(glb, 0, 2, "a.glb"), InputError);
}

}  // namespace
}  // namespace palmar::formats
