// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/study/assessment/assessment.h"

namespace palmar::study {

/// Why a hold is to be doubted although the product is in the hand.
struct HoldDoubt {
  std::string key;    ///< "not_at_rest", "slips_out", "few_contacts"
  std::string words;  ///< a clause for people
};

/// That it doesn't come to rest, slips out, takes more than the muscles can, or that fewer parts of
/// the hand touch the product than the grip needs (grip_needs.h). Empty: nothing speaks against it,
/// or nothing is held.
std::vector<HoldDoubt> doubts_of(const Assessment& assessment);

}  // namespace palmar::study
