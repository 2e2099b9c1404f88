// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/hand/load_hand.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"

namespace palmar {
namespace {

TEST(LoadHand, FileThatIsNotThereIsNamed) {
  try {
    load_hand("nowhere/no.hand.glb");
    FAIL() << "a hand was read from nowhere";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("nowhere/no.hand.glb"));
  }
}

}  // namespace
}  // namespace palmar
