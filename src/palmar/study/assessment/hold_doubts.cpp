// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/assessment/hold_doubts.h"

#include "palmar/grasp/grip_needs.h"

namespace palmar::study {

std::vector<HoldDoubt> doubts_of(const Assessment& assessment) {
  const grasp::GraspStatus held = assessment.grasp.status;
  if (held != grasp::GraspStatus::kHeld && held != grasp::GraspStatus::kPartlyHeld) return {};
  std::vector<HoldDoubt> doubts;
  const grasp::BalanceStatus rest = assessment.balance.status;
  if (rest == grasp::BalanceStatus::kSlipsOut) {
    doubts.push_back({"slips_out", assessment.balance.message});
  } else if (rest != grasp::BalanceStatus::kOff && rest != grasp::BalanceStatus::kBalanced &&
             rest != grasp::BalanceStatus::kSupported) {
    doubts.push_back({"not_at_rest", assessment.balance.message});
  }
  std::vector<hand::Region> touching;
  for (const contact::RegionContact& region : assessment.contact.regions)
    touching.push_back(region.region);
  const std::string lacking = grasp::lacking_contact(assessment.grasp.grip, touching);
  if (!lacking.empty()) doubts.push_back({"few_contacts", lacking});
  return doubts;
}

}  // namespace palmar::study
