// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/hand/load_hand.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"

namespace palmar::workflow {
namespace {

TEST(LoadHand, FileThatIsNotThereIsNamed) {
  try {
    load_hand("nowhere/no.hand.glb");
    FAIL() << "a hand was read from nowhere";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("nowhere/no.hand.glb"));
  }
}

TEST(PersonOfSize, IsNamedInWords) {
  EXPECT_EQ(name_of(PersonOfSize{grasp::Sex::kFemale, 5}),
            "woman of the 5th percentile (ANSUR II)");
  EXPECT_EQ(name_of(PersonOfSize{grasp::Sex::kMale, 51}), "man of the 51st percentile (ANSUR II)");
  EXPECT_EQ(name_of(PersonOfSize{grasp::Sex::kMale, 12}), "man of the 12th percentile (ANSUR II)");
  EXPECT_EQ(name_of(PersonOfSize{grasp::Sex::kFemale, 2.5}),
            "woman of the 2.5th percentile (ANSUR II)");
  EXPECT_THROW(PersonOfSize({grasp::Sex::kFemale, 0.0}).check(), UsageError);
  EXPECT_THROW(PersonOfSize({grasp::Sex::kFemale, 100.0}).check(), UsageError);
}

}  // namespace
}  // namespace palmar::workflow
