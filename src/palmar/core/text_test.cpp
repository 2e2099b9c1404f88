// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/core/text.h"

#include <gtest/gtest.h>

#include <vector>

namespace palmar {
namespace {

TEST(Significant, RoundsAndLeavesTrailingZerosOut) {
  EXPECT_EQ(significant(12.3456, 4), "12.35");
  EXPECT_EQ(significant(0.5, 4), "0.5");
  EXPECT_EQ(significant(-1234567.0, 3), "-1.23e+06");
  EXPECT_EQ(significant(0.0, 6), "0");
}

TEST(Counted, OnlyOneIsSingular) {
  EXPECT_EQ(counted(0, "hole", "holes"), "0 holes");
  EXPECT_EQ(counted(1, "hole", "holes"), "1 hole");
  EXPECT_EQ(counted(2, "hole", "holes"), "2 holes");
}

TEST(LowerCase, ChangesAsciiLettersOnly) {
  EXPECT_EQ(lower_case("Part 3.STEP"), "part 3.step");
  EXPECT_EQ(lower_case("\u00c4"), "\u00c4");
}

TEST(Trimmed, EndsWithoutBlanks) {
  EXPECT_EQ(trimmed(" \ta b\t"), "a b");
  EXPECT_EQ(trimmed(" \t"), "");
}

TEST(Joined, PutsTextBetweenWordsOnly) {
  const std::vector<std::string> words = {"a", "", "b"};
  EXPECT_EQ(joined(words, ", "), "a, , b");
  EXPECT_EQ(joined(std::span(words).first(1), ", "), "a");
  EXPECT_EQ(joined(std::span(words).first(0), ", "), "");
}

}  // namespace
}  // namespace palmar
