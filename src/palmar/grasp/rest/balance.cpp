// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/rest/balance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/grasp/equilibrium/least_effort.h"
#include "palmar/grasp/equilibrium/nearby_rests.h"
#include "palmar/grasp/precision/precision_grip.h"
#include "palmar/grasp/precision/precision_shape.h"
#include "palmar/grasp/rest/hold_at_rest.h"
#include "palmar/grasp/rest/way_words.h"

namespace palmar::grasp {
namespace {

constexpr double kBalanced = 0.01;   // residual over grip force; what counts as balanced
constexpr double kJointSaid = 0.05;  // residual moment over the strongest; more is a slip
constexpr double kNothingAt = 30.0;  // mm; at which too little force is too little moment
constexpr double kLost = 0.05;       // of the grip force asked for; less is a lost grip
constexpr double kLevelSaid = 0.05;  // of the grip force asked for

/// Which parts of the hand lie on what is held: all of them in a power grip, the fingers in a hook,
/// the pads that touch in a precision grip.
VolarVector parts_that_hold(const hand::Hand& hand, const Grasp& grasp) {
  if (is_laid(grasp.grip) || is_by_whole_hand(grasp.grip)) return VolarVector::Ones();
  VolarVector parts = VolarVector::Zero();
  const auto take = [&](hand::Segment segment) { parts[static_cast<int>(segment) - 1] = 1.0; };
  if (grasp.grip == Grip::kFixedHook) {
    for (int s = static_cast<int>(hand::Segment::kIndexProximal); s < hand::kSegmentCount; ++s) {
      take(static_cast<hand::Segment>(s));
    }
    return parts;
  }
  if (grasp.grip == Grip::kFingerPush) {
    take(hand::Segment::kIndexDistal);
    return parts;
  }
  for (const FingertipPoint& tip : fingertips_of(hand, grasp.grip)) {
    const bool is_volar = tip.part == FingertipPart::kPad || tip.part == FingertipPart::kTip ||
                          tip.part == FingertipPart::kMiddlePad;
    if (is_volar) take(tip.segment);
  }
  return parts;
}

bool pulls(const contact::ProductLoad& load) {
  return load.weight > 0.0 || !load.force.isZero(0.0) || !load.torque.isZero(0.0);
}

bool carries(const Grasp& grasp, const BalanceOptions& options) {
  return grasp.grip == Grip::kFixedHook && !options.turn;
}

/// What pulls at the product; nothing but what it carries closes a hook.
contact::ProductLoad load_of(const product::Product& product, const Grasp& grasp,
                             const BalanceOptions& options) {
  contact::ProductLoad load = options.load;
  if (carries(grasp, options) && !pulls(load)) {
    HeaviestLoad own;
    own.add(product, {});
    load.weight = own.force;
  }
  return load;
}

EffortTask task_of(const hand::Hand& hand, const product::Product& product, const Grasp& grasp,
                   const contact::ProductLoad& load, const BalanceOptions& options) {
  EffortTask task;
  task.force = options.asked_grip_force(grasp.grip);
  task.is_hardest = options.activation.has_value();
  task.takes_part = parts_that_hold(hand, grasp);
  task.friction = options.friction;
  task.strength = options.activation.value_or(options.strength);
  task.wrist = options.wrist;
  if (is_non_prehensile(grasp.grip)) {
    // What the product stands on carries all but the push, and any load; nothing slides.
    task.measure = EffortMeasure::kPush;
    task.friction = 0.0;
    task.along = grasp.grip == Grip::kFingerPush && !grasp.fingertips.empty()
                     ? Vec3(-grasp.fingertips.front().normal)
                     : Vec3(grasp.product_from_hand.rotation * Vec3::UnitZ());
    return task;
  }
  if (options.turn) {
    task.measure = EffortMeasure::kTurn;
    task.along = grasp.grip_axis;
    task.force = std::abs(*options.turn);
    if (*options.turn < 0.0) task.along = -task.along;
    // As people leave it before a slip.
    task.friction = options.friction / kGripMargin;
  }
  const bool is_weight_alone = load.force.isZero(0.0) && load.torque.isZero(0.0);
  if (carries(grasp, options) && load.weight > 0.0 && !load.gravity && is_weight_alone) {
    task.measure = EffortMeasure::kHang;
    task.hangs_at = load.mass_centre.value_or(geometry::centre_of_volume(product.mesh));
    task.force = load.weight;
    task.is_hardest = false;
    return task;
  }
  if (pulls(load)) {
    task.load = contact::wrench_of(load, geometry::centre_of_volume(product.mesh));
    if (carries(grasp, options)) task.measure = EffortMeasure::kNone;
  }
  return task;
}

/// A grasp at rest with least effort, from how it was closed or as another hand holds it.
Balance settle(const contact::PreparedHand& hand, const product::Product& product, Grasp& grasp,
               const BalanceOptions& options, const contact::ContactOptions& contact,
               const Progress& progress) {
  Balance balance;
  balance.load = load_of(product, grasp, options);
  const EffortTask task = task_of(hand.hand(), product, grasp, balance.load, options);
  GripState closed{grasp.posture, grasp.product_from_hand};
  std::optional<SearchStart> from;
  if (options.like != nullptr) {
    const double length = hand.hand().dimensions.hand_length;
    closed = options.like->scaled(options.like->closed, length);
    from = SearchStart{options.like->scaled(options.like->rest, length),
                       options.like->scaled(options.like->on_coarse_skin, length)};
  }
  EffortRest rest = rest_with_least_effort(hand, product, closed, task, contact, progress,
                                           from ? &*from : nullptr);
  std::optional<EffortRest> other;
  const bool looks_beside = options.looks_beside || options.looks_nearby;
  if (looks_beside && rest.status == EffortRest::Status::kSolved) {
    other = other_rest(hand, product, rest, task, contact, progress);
    if (other && other->merit.back() < rest.merit.back()) {
      std::swap(*other, rest);
      if (!is_doubt(rest, *other)) other.reset();
    }
  }
  balance.iterations = rest.iterations;
  balance.on_coarse_skin = rest.on_coarse_skin;
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
  balance.friction = task.friction;
  const bool turns = task.measure == EffortMeasure::kTurn;
  balance.grip_force = turns ? rest.grip.force : rest.force;
  if (turns) balance.turn = std::copysign(rest.force, *options.turn);
  if (task.measure == EffortMeasure::kHang) balance.load.gravity = -rest.force_on_product;
  balance.sum_of_normals = rest.grip.sum_of_normals;
  balance.residual_force = rest.missing.segment<3>(kGripJoints).norm();
  balance.residual_moment = rest.missing.tail<3>().norm();
  balance.residual_share =
      std::max(balance.residual_force, balance.residual_moment / rest.arm) / balance.grip_force;
  balance.friction_use = rest.friction_use;
  balance.friction_force = rest.friction_force;
  balance.moved = rest.moved;
  balance.turned = rest.turned;
  balance.is_by_wrist = rest.is_by_wrist;
  balance.joint_load = rest.load;

  const double at_joints = rest.missing.head<kGripJoints>().lpNorm<Eigen::Infinity>();
  const double allowed_force = std::max(kBalanced * balance.grip_force, task.model.nothing);
  const double no_moment = task.model.nothing * kNothingAt;
  const double allowed_moment = std::max(kBalanced * balance.grip_force * rest.arm, no_moment);
  const bool is_force_held = balance.residual_force < allowed_force;
  const bool is_moment_held = balance.residual_moment < allowed_moment;
  const double asked = task.force.value_or(rest.force);
  if (!task.is_hardest && !turns && rest.force < kLost * asked) {
    balance.status = BalanceStatus::kSlipsOut;
    balance.message = fmt::format(
        "slips out: {:.1f} N are left of the {:.0f} N that were requested", rest.force, asked);
    return balance;
  }
  const double allowed_at_joints = std::max(kJointSaid * rest.strongest_moment, no_moment);
  if (is_force_held && is_moment_held && at_joints < allowed_at_joints) {
    // Of light holds it would be what it takes to keep the posture.
    if (task.takes_part.minCoeff() > 0.0 && !options.is_light()) {
      balance.strength_use = rest.share * task.strength / options.strength;
    }
    if (options.looks_nearby) {
      NearbyRests nearby = nearby_rests(hand, product, rest, task, contact);
      if (other) {
        nearby.other = {.state = other->state, .merit = other->merit.back() / rest.merit.back()};
      }
      balance.nearby = std::make_shared<const NearbyRests>(std::move(nearby));
    }
    if (task.measure == EffortMeasure::kPush) {
      balance.status = BalanceStatus::kSupported;
      balance.message =
          fmt::format("{} with {:.1f} N; what it stands on carries that",
                      grasp.grip == Grip::kFingerPush ? "is pushed" : "is rested on", rest.force);
    } else {
      balance.status = BalanceStatus::kBalanced;
      balance.message =
          turns ? fmt::format("turns it with {:.1f} N m at a grip force of {:.0f} N",
                              1e-3 * *balance.turn, balance.grip_force)
                : fmt::format("in balance at a grip force of {:.0f} N", balance.grip_force);
    }
    if (!task.is_hardest && std::abs(rest.force / asked - 1.0) > kLevelSaid) {
      balance.message += fmt::format(
          "; {} were requested, which the hand doesn't reach",
          turns ? fmt::format("{:.1f} N m", 1e-3 * asked) : fmt::format("{:.0f} N", asked));
    }
    return balance;
  }
  balance.status = BalanceStatus::kSlipsOut;
  if (!is_force_held) {
    // What is missing is what would have to push the product back.
    balance.slip = -rest.missing.segment<3>(kGripJoints).normalized();
    balance.message = fmt::format("slips out, towards {}: {:.1f} N and {:.0f} N mm are missing",
                                  way_words(hand.hand(), *balance.slip), balance.residual_force,
                                  balance.residual_moment);
  } else if (!is_moment_held) {
    balance.message =
        fmt::format("turns in the hand: {:.0f} N mm are missing", balance.residual_moment);
  } else {
    balance.message = fmt::format(
        "slips out: the muscles lack {:.0f} N mm about a joint of a finger or the thumb",
        at_joints);
  }
  balance.message += fmt::format(" at a grip force of {:.0f} N", balance.grip_force);
  return balance;
}

/// A precision grip comes to rest; if it doesn't where fingertips were first put, people put them
/// elsewhere: where the search found the next best places.
Balance settle_precision(const contact::PreparedHand& hand, const product::Product& product,
                         Grasp& grasp, const BalanceOptions& options,
                         const contact::ContactOptions& contact, const Progress& progress) {
  const Grasp chosen = grasp;
  const Balance first = settle(hand, product, grasp, options, contact, progress);
  const bool is_whole = chosen.status == GraspStatus::kHeld;
  if (first.status != BalanceStatus::kSlipsOut || !is_whole) return first;
  for (std::size_t i = 0; i < chosen.runners_up.size(); ++i) {
    const GraspRunnerUp& other = chosen.runners_up[i];
    if (other.hold || other.grip != chosen.grip) continue;  // another hold is never taken unasked
    Grasp there = chosen;
    take_runner_up(hand.hand(), product, i, there);
    if (there.status != GraspStatus::kHeld) continue;
    const Balance balance = settle(hand, product, there, options, contact, progress);
    if (balance.status != BalanceStatus::kBalanced) continue;
    there.message += "; the place first chosen: " + first.message;
    grasp = std::move(there);
    return balance;
  }
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
  if (options.like != nullptr) {
    BalanceOptions own = options;
    own.like = nullptr;
    const bool is_asked =
        options.asked_grip_force(grasp.grip) || options.turn || options.activation;
    if (!is_asked || !is_by_whole_hand(grasp.grip)) {
      return balance_grasp(hand, product, grasp, own, contact, progress);
    }
    Grasp there = grasp;
    const Balance balance = settle(hand, product, there, options, plain, progress);
    if (balance.status != BalanceStatus::kBalanced) {
      return balance_grasp(hand, product, grasp, own, contact, progress);
    }
    grasp = std::move(there);
    return balance;
  }
  const bool has_other_places = !is_power(grasp.grip) && !is_non_prehensile(grasp.grip);
  return has_other_places ? settle_precision(hand, product, grasp, options, plain, progress)
                          : settle(hand, product, grasp, options, plain, progress);
}

}  // namespace palmar::grasp
