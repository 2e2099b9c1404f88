// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/statistics/study_holds.h"

#include <algorithm>
#include <utility>

#include "palmar/grasp/grip_needs.h"

namespace palmar::study {
namespace {

bool is_same_way(const std::optional<StudyHold>& a, const std::optional<StudyHold>& b) {
  return a && b ? is_same(*a, *b) : !a && !b;
}

}  // namespace

std::vector<HandsByHold> holds_of(const StudyResults& results, const StudyCondition& condition,
                                  int product) {
  std::vector<HandsByHold> holds;
  for (const int hand : hands_of(results.plan, condition)) {
    const StudyRecord* record = record_of(results, condition, product, hand);
    if (record == nullptr || record->outcome == StudyOutcome::kFailed) continue;
    auto known = std::find_if(holds.begin(), holds.end(), [&](const HandsByHold& one) {
      return is_same_way(one.hold, record->hold);
    });
    if (known == holds.end()) known = holds.insert(holds.end(), {record->hold, 0});
    ++known->hands;
  }
  std::stable_sort(holds.begin(), holds.end(),
                   [](const HandsByHold& a, const HandsByHold& b) { return a.hands > b.hands; });
  return holds;
}

std::string words_of(const std::vector<HandsByHold>& holds) {
  std::string words;
  for (const HandsByHold& one : holds) {
    words += (words.empty() ? "" : "; ") + std::to_string(one.hands) +
             (one.hands == 1 ? " hand: " : " hands: ") +
             (one.hold ? one.hold->words : "where coordinates say");
  }
  return words;
}

int hands_with_little(const StudyResults& results, const StudyCondition& condition, int product) {
  int hands = 0;
  for (const int hand : hands_of(results.plan, condition)) {
    const StudyRecord* record = record_of(results, condition, product, hand);
    if (record == nullptr || !is_in_hand(*record) || record->regions.empty()) continue;
    std::vector<hand::Region> touching;
    for (const RegionRecord& region : record->regions) touching.push_back(region.region);
    hands += grasp::lacking_contact(record->grip, touching).empty() ? 0 : 1;
  }
  return hands;
}

}  // namespace palmar::study
