// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/redesign/hold_change.h"

#include <fmt/format.h>

#include <algorithm>

#include "palmar/geometry/degrees.h"
#include "palmar/statistics/summary.h"

namespace palmar::workflow {
namespace {

constexpr double kOtherTurn =
    30.0 * geometry::kDegree;         // of a redesign against the original in the hand
constexpr double kOtherShift = 10.0;  // mm, the same; our choice

}  // namespace

bool HoldChange::is_other_hold() const { return turn > kOtherTurn || shift > kOtherShift; }

std::vector<HoldChange> hold_changes(const study::StudyResults& results, const Vec3& place) {
  std::vector<HoldChange> changes;
  const study::StudyCondition condition = study::conditions_of(results.plan).front();
  for (std::size_t p = 1; p < results.plan.products.size(); ++p) {
    HoldChange change{.redesign = results.plan.products[p].name};
    std::vector<double> turns, shifts;
    for (const int hand : study::hands_of(results.plan, condition)) {
      const study::StudyRecord* before = study::record_of(results, condition, 0, hand);
      const study::StudyRecord* after =
          study::record_of(results, condition, static_cast<int>(p), hand);
      if (before == nullptr || after == nullptr || !study::is_in_hand(*before) ||
          !study::is_in_hand(*after)) {
        continue;
      }
      const geometry::Rigid3 &a = before->product_from_hand, &b = after->product_from_hand;
      turns.push_back(a.rotation.angularDistance(b.rotation));
      shifts.push_back((a.inverse() * place - b.inverse() * place).norm());
    }
    if (!turns.empty()) {
      change.hands = static_cast<int>(turns.size());
      std::sort(turns.begin(), turns.end());
      std::sort(shifts.begin(), shifts.end());
      change.turn = statistics::quantile(turns, 0.5);
      change.largest_turn = turns.back();
      change.shift = statistics::quantile(shifts, 0.5);
      change.largest_shift = shifts.back();
    }
    changes.push_back(std::move(change));
  }
  return changes;
}

std::string words_of(const HoldChange& change) {
  if (change.hands == 0) return "";
  std::string text = fmt::format(
      "{} lies {:.1f} degrees and {:.1f} mm away from where the original lies in the hand "
      "(median of {} hands; at most {:.1f} degrees, {:.1f} mm)",
      change.redesign, change.turn / geometry::kDegree, change.shift, change.hands,
      change.largest_turn / geometry::kDegree, change.largest_shift);
  if (change.is_other_hold()) {
    text += ": it is held in another way, so that a difference may be the hold's";
  }
  return text;
}

}  // namespace palmar::workflow
