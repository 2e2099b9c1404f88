// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/rest/place_at_rest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "palmar/grasp/grip_needs.h"
#include "palmar/grasp/holds/firm_hold.h"
#include "palmar/grasp/holds/offered_holds.h"
#include "palmar/hand/skin/skinning.h"

namespace palmar::grasp {
namespace {

constexpr double kAsGoodAHold = 0.2;   // how often, at least, people take what is taken instead
constexpr std::size_t kMostTried = 4;  // of the next holds: each takes as long as a grasp; choice

/// A hold's score, with what its grip makes of the force that is asked for.
double score_of(const RankedHold& hold, const GraspOptions& options) {
  return hold.score +
         (options.grip_force ? force_term(*options.grip_force, hold.hold.grip).score : 0.0);
}

/// Numbers of the holds that are as good as the one that is taken, that one itself first, then the
/// best. Of power holds that only turn about the same place the best stands for all.
std::vector<int> as_good_as_taken(const RankedHolds& ranked, const GraspOptions& options) {
  const auto hold = [&](int number) -> const RankedHold& {
    return ranked.holds[static_cast<std::size_t>(number) - 1];
  };
  const auto score = [&](int number) { return score_of(hold(number), options); };
  std::vector<int> sorted;
  for (int number = 1; number <= static_cast<int>(ranked.holds.size()); ++number) {
    if (score(number) >= score(ranked.taken) + std::log(kAsGoodAHold)) sorted.push_back(number);
  }
  std::stable_sort(sorted.begin(), sorted.end(), [&](int a, int b) {
    return std::tuple(a != ranked.taken, -score(a)) < std::tuple(b != ranked.taken, -score(b));
  });
  std::vector<int> numbers;
  std::set<std::string> seen;
  for (const int number : sorted) {
    const bool is_new = seen.insert(hold(number).words).second || !is_power(hold(number).hold.grip);
    if (is_new && numbers.size() <= kMostTried) numbers.push_back(number);
  }
  return numbers;
}

}  // namespace

std::string flaw_at_rest(const contact::PreparedHand& hand, const product::Product& product,
                         const Grasp& grasp, const BalanceOptions& balance,
                         const contact::ContactOptions& contact, const Progress& progress) {
  if (grasp.status != GraspStatus::kHeld) return grasp.message;
  Grasp resting = grasp;
  const Balance rest = balance_grasp(hand, product, resting, balance, contact, progress);
  if (rest.status == BalanceStatus::kSupported) return "";
  if (rest.status != BalanceStatus::kBalanced && rest.status != BalanceStatus::kOff) {
    return rest.message;
  }
  contact::ContactOptions plain = contact;
  plain.error_band = false;
  const contact::ContactResult touched =
      contact::solve_hand_contact(hand, hand::pose_skin(hand.hand(), resting.posture),
                                  resting.product_from_hand, *product.distance, plain);
  std::vector<hand::Region> touching;
  for (const contact::RegionContact& region : touched.regions) touching.push_back(region.region);
  return lacking_contact(resting.grip, touching);
}

std::optional<GraspPlace> other_place_at_rest(
    const contact::PreparedHand& hand, const product::Product& product, const GraspPlace& place,
    const std::string& flaw, const GraspOptions& options, const BalanceOptions& balance,
    const contact::ContactOptions& contact, const Progress& progress) {
  if (place.ranked().holds.empty()) return std::nullopt;
  const std::string why =
      fmt::format("the hold first chosen, {}: {}", place.reference_grasp().hold_words, flaw);
  const auto first_at_rest = [&](const GraspPlace& from, bool skips_taken) {
    std::optional<GraspPlace> found;
    for (const int number : as_good_as_taken(from.ranked(), options)) {
      progress.throw_if_cancelled();
      if (skips_taken && number == from.ranked().taken) continue;
      GraspPlace other = from.with_hold(number, why, progress);
      if (!flaw_at_rest(hand, product, other.reference_grasp(), balance, contact, progress)
               .empty()) {
        continue;
      }
      found = std::move(other);
      break;
    }
    return found;
  };
  if (auto other = first_at_rest(place, true)) return other;
  GraspOptions over = options;
  over.holds.purpose = HoldPurpose::kHandOver;
  over.holds.grip = options.grip;
  const bool has_use = place.ranked().has_handle || is_non_prehensile(place.reference_grasp().grip);
  if (has_use || are_offered(options.holds) || !are_offered(over.holds)) return std::nullopt;
  const GraspPlace picked_up(hand.hand(), product, over, progress);
  return picked_up.ranked().holds.empty() ? std::nullopt : first_at_rest(picked_up, false);
}

std::optional<Grip> other_grip_that_holds(const contact::PreparedHand& hand,
                                          const product::Product& product,
                                          const GraspOptions& asked, const BalanceOptions& balance,
                                          const contact::ContactOptions& contact,
                                          const Progress& progress) {
  GraspOptions open;
  open.parts = asked.parts;
  open.holds = asked.holds;
  open.grip_force = asked.grip_force;
  const GraspPlace place(hand.hand(), product, open, progress);
  const std::string flaw =
      flaw_at_rest(hand, product, place.reference_grasp(), balance, contact, progress);
  if (flaw.empty()) return place.reference_grasp().grip;
  const auto other =
      other_place_at_rest(hand, product, place, flaw, open, balance, contact, progress);
  return other ? std::optional(other->reference_grasp().grip) : std::nullopt;
}

}  // namespace palmar::grasp
