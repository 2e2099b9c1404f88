// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/study/statistics/study_results.h"

namespace palmar::study {

/// How some of a condition's hands hold a product.
struct HandsByHold {
  std::optional<StudyHold> hold;  ///< nothing: by coordinates, or the study doesn't say
  int hands = 0;                  ///< that were to hold it so, whether or not they can
};

/// The holds of a product in a condition, that of most hands first. One entry: hands differ in
/// size, not in how they hold. Empty if nothing was run.
std::vector<HandsByHold> holds_of(const StudyResults& results, const StudyCondition& condition,
                                  int product);

/// "28 hands: medium wrap of the handle; 2 hands: fixed hook of the handle".
std::string words_of(const std::vector<HandsByHold>& holds);

/// How many hands of a condition hold a product by fewer parts of the hand than their grip needs
/// (grip_needs.h).
int hands_with_little(const StudyResults& results, const StudyCondition& condition, int product);

}  // namespace palmar::study
