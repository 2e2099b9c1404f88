// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/assessment/hold_doubts.h"

#include <gtest/gtest.h>

namespace palmar::study {
namespace {

Assessment wrap_with(const std::vector<hand::Region>& touching) {
  Assessment assessment;
  assessment.grasp.grip = grasp::Grip::kLargeDiameter;
  assessment.grasp.status = grasp::GraspStatus::kHeld;
  assessment.balance.status = grasp::BalanceStatus::kBalanced;
  for (const hand::Region region : touching) {
    contact::RegionContact contact;
    contact.region = region;
    assessment.contact.regions.push_back(contact);
  }
  return assessment;
}

std::string keys_of(const std::vector<HoldDoubt>& doubts) {
  std::string keys;
  for (const HoldDoubt& one : doubts) keys += (keys.empty() ? "" : " ") + one.key;
  return keys;
}

const std::vector<hand::Region> kWhole = {hand::Region::kThumbDistal, hand::Region::kIndexDistal,
                                          hand::Region::kMiddleDistal, hand::Region::kCentralPalm};
const std::vector<hand::Region> kThumbless = {
    hand::Region::kIndexDistal, hand::Region::kMiddleDistal, hand::Region::kCentralPalm};

TEST(HoldDoubts, AWholeHoldAtRestHasNone) { EXPECT_TRUE(doubts_of(wrap_with(kWhole)).empty()); }

TEST(HoldDoubts, AWrapWithoutThumbIsDoubtful) {
  const std::vector<HoldDoubt> doubts = doubts_of(wrap_with(kThumbless));
  EXPECT_EQ(keys_of(doubts), "few_contacts");
  EXPECT_EQ(doubts.front().words, "the thumb doesn't touch it, which a large diameter needs");
}

TEST(HoldDoubts, WhatSlipsOrDoesntComeToRestIsDoubtful) {
  Assessment assessment = wrap_with(kWhole);
  assessment.balance.status = grasp::BalanceStatus::kSlipsOut;
  EXPECT_EQ(keys_of(doubts_of(assessment)), "slips_out");
  assessment.balance.status = grasp::BalanceStatus::kFailed;
  EXPECT_EQ(keys_of(doubts_of(assessment)), "not_at_rest");
  assessment.balance.status = grasp::BalanceStatus::kOff;  // nobody asked for it
  EXPECT_EQ(keys_of(doubts_of(assessment)), "");
  assessment = wrap_with(kThumbless);
  assessment.balance.status = grasp::BalanceStatus::kSlipsOut;
  EXPECT_EQ(keys_of(doubts_of(assessment)), "slips_out few_contacts");
}

TEST(HoldDoubts, WhatIsNotHeldNeedsNoDoubt) {
  Assessment assessment = wrap_with({});
  assessment.grasp.status = grasp::GraspStatus::kTooLarge;
  EXPECT_TRUE(doubts_of(assessment).empty());
}

}  // namespace
}  // namespace palmar::study
