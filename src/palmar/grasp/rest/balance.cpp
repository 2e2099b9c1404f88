// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/rest/balance.h"

#include <fmt/format.h>

#include <utility>

#include "palmar/grasp/precision/precision_grip.h"
#include "palmar/grasp/rest/press_down.h"
#include "palmar/grasp/rest/settling.h"

namespace palmar::grasp {
namespace {

constexpr double kShifted = 5.0;  // mm; a precision grip in which the product shifts more is poor

/// A precision grip comes to rest; if it doesn't where fingertips were first put, people put them
/// elsewhere: where the search found the next best places.
Balance settle_precision(const contact::PreparedHand& hand, const product::Product& product,
                         Grasp& grasp, const BalanceOptions& options,
                         const contact::ContactOptions& contact, const Progress& progress) {
  const std::size_t others = grasp.status == GraspStatus::kHeld ? grasp.runners_up.size() : 0;
  Balance first;
  Grasp nearest = grasp;  // where it is at rest or the first comes near to that
  for (std::size_t i = 0; i <= others; ++i) {
    // Runners-up of another grip are other holds: never taken unasked.
    if (i > 0 && grasp.runners_up[i - 1].grip != grasp.grip) continue;
    Grasp there = grasp;
    if (i > 0) take_runner_up(hand.hand(), product, i - 1, there);
    if (i > 0 && there.status != GraspStatus::kHeld) continue;
    Settling settling(hand, product, there, options, contact, SettlingWay::kStiff);
    Balance balance = settling.run(progress);
    const bool is_at_rest = balance.status == BalanceStatus::kBalanced;
    const bool is_near = balance.status == BalanceStatus::kNotConverged;
    if (is_at_rest || is_near) {
      there.posture = settling.state().posture;
      there.product_from_hand = settling.state().product_from_hand;
    }
    if (is_at_rest && balance.moved < kShifted) {
      if (i > 0) there.message += "; the place first chosen: " + first.message;
      grasp = std::move(there);
      return balance;
    }
    if (i == 0 || (is_at_rest && first.status != BalanceStatus::kBalanced)) {
      if (is_near || is_at_rest) nearest = std::move(there);
      first = std::move(balance);
    }
    if (first.status == BalanceStatus::kNoContact || first.status == BalanceStatus::kFailed) break;
  }
  grasp = std::move(nearest);
  return first;
}

}  // namespace

Balance balance_grasp(const contact::PreparedHand& hand, const product::Product& product,
                      Grasp& grasp, const BalanceOptions& options,
                      const contact::ContactOptions& contact, const Progress& progress) {
  options.check();
  contact.check();
  if (!options.is_on) return {};
  contact::ContactOptions plain = contact;
  plain.error_band = false;
  if (is_non_prehensile(grasp.grip)) {
    return press_down(hand, product, grasp, options, plain, progress);
  }
  if (!is_power(grasp.grip)) {
    return settle_precision(hand, product, grasp, options, plain, progress);
  }
  // A large body slips past muscles of least effort. Then they are tried so that it stays where it
  // is, and last the hand stiff: all joints held as they were closed. Hooked fingers meet no palm
  // that would hold against them: stiff from the start.
  const bool has_muscles = grasp.grip != Grip::kFixedHook;
  Balance balance;
  for (const SettlingWay way :
       {SettlingWay::kLeastEffort, SettlingWay::kInPlace, SettlingWay::kStiff}) {
    if (way != SettlingWay::kStiff && !has_muscles) continue;
    Settling settling(hand, product, grasp, options, plain, way);
    Balance attempt = settling.run(progress);
    const bool is_first = way == SettlingWay::kLeastEffort || !has_muscles;
    const bool is_at_rest = attempt.status == BalanceStatus::kBalanced;
    const bool slips = attempt.status == BalanceStatus::kSlipsOut;
    if (is_at_rest || (is_first && attempt.status == BalanceStatus::kNotConverged)) {
      grasp.posture = settling.state().posture;
      grasp.product_from_hand = settling.state().product_from_hand;
    }
    if (is_at_rest || is_first) balance = std::move(attempt);
    if (is_at_rest && way == SettlingWay::kStiff && has_muscles) {
      balance.message += ", by fingers that are held stiff";
    }
    if (is_at_rest && balance.is_overloaded) {
      balance.message +=
          balance.strength_use
              ? fmt::format(", which takes {:.1f} times the strength of the muscles{}",
                            *balance.strength_use, balance.is_by_wrist ? " of the wrist" : "")
              : ", which no muscles could";
    }
    if (is_at_rest || (is_first && !slips)) break;
  }
  return balance;
}

}  // namespace palmar::grasp
