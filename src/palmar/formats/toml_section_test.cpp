// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/toml_section.h"

#include <gtest/gtest.h>

#include "palmar/core/error.h"
#include "palmar/formats/test_files.h"

namespace palmar::formats {
namespace {

std::string dotted_key(int parts) {
  std::string key = "a";
  for (int i = 1; i < parts; ++i) key += ".a";
  return key;
}

std::string refusal(const std::string& text) {
  return message_of<InputError>([&] { parse_toml(text, "x.toml"); });
}

// 40 000 parts ended the program when the tables were freed.
TEST(TomlSection, RefusesKeysOfManyParts) {
  EXPECT_EQ(refusal("b = 1\n" + dotted_key(40000) + " = 1\n"),
            "x.toml:2: no TOML: a key has more than 100 parts; 100 are allowed");
  EXPECT_NE(refusal("[" + dotted_key(101) + "]\n"), "");
  EXPECT_NE(refusal("\"a\" . " + dotted_key(101) + " = 1\n"), "");
  EXPECT_EQ(parse_toml(dotted_key(100) + " = 1\n", "x.toml").size(), 1U);
}

TEST(TomlSection, ReadsDotsThatAreNoKeys) {
  const std::string dots(300, '.');
  EXPECT_EQ(refusal("# " + dots + "\na = \"" + dots + "\"\n"), "");
  std::string numbers = "a = [";
  for (int i = 0; i < 300; ++i) numbers += "0.5, ";
  EXPECT_EQ(refusal(numbers + "]\n"), "");
}

TEST(TomlSection, NamesTheLineOfWhatIsNoToml) {
  EXPECT_EQ(refusal("a = 1\nb =\n").rfind("x.toml:2: no TOML: ", 0), 0U);
}

}  // namespace
}  // namespace palmar::formats
