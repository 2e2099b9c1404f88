// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/hand/tissue_on_bone.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"

namespace palmar::workflow {
namespace {

/// A hand that no file is about.
hand::Hand unknown_hand(const std::string& name) {
  hand::Hand hand;
  hand.name = name;
  hand.skin.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  hand.skin.triangles = {{0, 1, 2}};
  return hand;
}

/// What is said before a compliance is made; then it is called off.
std::string said_of(const hand::Hand& hand) {
  std::string said;
  const NoteSink stop = [&](const std::string& text) {
    said = text;
    throw Cancelled("heard enough");
  };
  EXPECT_THROW(tissue_on_bone(hand, {.tissue = contact::TissueModel::kBone}, stop), Cancelled);
  return said;
}

TEST(TissueOnBone, SaysWhenOneHasToBeMade) {
  const std::string said = said_of(unknown_hand("mine"));
  EXPECT_THAT(said, testing::HasSubstr("\"mine\""));
  EXPECT_THAT(said, testing::HasSubstr("13 s"));
  EXPECT_THAT(said, testing::Not(testing::HasSubstr("template.compliance")));
}

TEST(TissueOnBone, NamesTheTemplatesFileAndWhatMakesIt) {
  const std::string said = said_of(unknown_hand("template"));
  EXPECT_THAT(said, testing::HasSubstr("/template.compliance is missing, cut"));
  EXPECT_THAT(said, testing::HasSubstr("palmar hand template --out"));
  EXPECT_THAT(said, testing::HasSubstr("--compliance"));
}

TEST(TissueOnBone, OtherModelsNeedNone) {
  EXPECT_EQ(tissue_on_bone(unknown_hand("template"), {.tissue = contact::TissueModel::kHalfSpace},
                           [](const std::string& text) { FAIL() << text; }),
            nullptr);
}

}  // namespace
}  // namespace palmar::workflow
