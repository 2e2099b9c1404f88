// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/rest/balance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/grasp/equilibrium/least_effort.h"
#include "palmar/grasp/precision/precision_grip.h"
#include "palmar/grasp/rest/press_down.h"
#include "palmar/grasp/rest/settling.h"
#include "palmar/grasp/rest/way_words.h"

namespace palmar::grasp {
namespace {

constexpr double kBalanced = 0.01;   // residual over grip force; what counts as balanced
constexpr double kJointSaid = 0.05;  // residual moment over the strongest; more is a slip
constexpr double kLevelSaid = 0.05;  // of the grip force asked for
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
    Settling settling(hand, product, there, options, contact);
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

/// A power grip at rest with least effort.
Balance settle_with_least_effort(const contact::PreparedHand& hand, const product::Product& product,
                                 Grasp& grasp, const BalanceOptions& options,
                                 const contact::ContactOptions& contact, const Progress& progress) {
  EffortTask task{.grip_force = options.asked_grip_force(grasp.grip),
                  .is_hardest = options.activation.has_value(),
                  .load = {},
                  .friction = options.friction,
                  .strength = options.activation.value_or(options.strength),
                  .wrist = options.wrist};
  if (options.load.weight > 0.0 || !options.load.force.isZero(0.0) ||
      !options.load.torque.isZero(0.0)) {
    task.load = contact::wrench_of(options.load, geometry::centre_of_volume(product.mesh));
  }
  const GripState closed{grasp.posture, grasp.product_from_hand};
  const EffortRest rest = rest_with_least_effort(hand, product, closed, task, contact, progress);
  Balance balance;
  balance.iterations = rest.iterations;
  balance.fallbacks = rest.fallbacks;
  if (rest.status == EffortRest::Status::kNoSolution) {
    balance.status = BalanceStatus::kFailed;
    balance.message = "the contact could not be solved while the grasp came to rest";
    return balance;
  }
  if (rest.status == EffortRest::Status::kNoContact) {
    balance.status = BalanceStatus::kNoContact;
    balance.message = "nothing is touched, so nothing can come to rest";
    return balance;
  }
  grasp.posture = rest.state.posture;
  grasp.product_from_hand = rest.state.product_from_hand;
  balance.friction = options.friction;
  balance.grip_force = rest.grip.force;
  balance.sum_of_normals = rest.grip.sum_of_normals;
  balance.residual_force = rest.missing.segment<3>(kGripJoints).norm();
  balance.residual_moment = rest.missing.tail<3>().norm();
  balance.residual_share =
      std::max(balance.residual_force, balance.residual_moment / rest.arm) / rest.grip.force;
  balance.friction_use = rest.friction_use;
  balance.friction_force = rest.friction_force;
  balance.moved = rest.moved;
  balance.turned = rest.turned;
  balance.is_by_wrist = rest.is_by_wrist;
  balance.joint_load = rest.load;

  const double at_joints = rest.missing.head<kGripJoints>().lpNorm<Eigen::Infinity>();
  const double allowed = std::max(kBalanced, task.model.nothing / rest.grip.force);
  if (balance.residual_share < allowed && at_joints < kJointSaid * rest.strongest_moment) {
    balance.status = BalanceStatus::kBalanced;
    balance.strength_use = rest.share * task.strength / options.strength;
    balance.message = fmt::format("in balance at a grip force of {:.0f} N", rest.grip.force);
    const double asked = task.grip_force.value_or(rest.grip.force);
    if (!task.is_hardest && std::abs(rest.grip.force / asked - 1.0) > kLevelSaid) {
      balance.message +=
          fmt::format("; {:.0f} N were requested, which the hand doesn't reach", asked);
    }
    return balance;
  }
  balance.status = BalanceStatus::kSlipsOut;
  if (balance.residual_force >= allowed * rest.grip.force) {
    // What is missing is what would have to push the product back.
    balance.slip = -rest.missing.segment<3>(kGripJoints).normalized();
    balance.message = fmt::format("slips out, towards {}: {:.1f} N and {:.0f} N mm are missing",
                                  way_words(hand.hand(), *balance.slip), balance.residual_force,
                                  balance.residual_moment);
  } else if (balance.residual_share >= allowed) {
    balance.message =
        fmt::format("turns in the hand: {:.0f} N mm are missing", balance.residual_moment);
  } else {
    balance.message = fmt::format(
        "slips out: the muscles lack {:.0f} N mm about a joint of a finger or the thumb",
        at_joints);
  }
  balance.message += fmt::format(" at a grip force of {:.0f} N", rest.grip.force);
  return balance;
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
  if (grasp.grip != Grip::kFixedHook) {
    return settle_with_least_effort(hand, product, grasp, options, plain, progress);
  }
  // Hooked fingers meet no palm that would hold against them: all joints stay as they were closed.
  Settling settling(hand, product, grasp, options, plain);
  Balance balance = settling.run(progress);
  if (balance.status == BalanceStatus::kBalanced ||
      balance.status == BalanceStatus::kNotConverged) {
    grasp.posture = settling.state().posture;
    grasp.product_from_hand = settling.state().product_from_hand;
  }
  return balance;
}

}  // namespace palmar::grasp
