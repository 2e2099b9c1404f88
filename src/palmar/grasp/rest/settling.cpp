// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/rest/settling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "palmar/core/error.h"
#include "palmar/geometry/degrees.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/grasp/rest/way_words.h"
#include "palmar/hand/skeleton.h"

namespace palmar::grasp {
namespace {

constexpr double kBalanced = 0.01;   // residual over grip force; what counts as balanced
constexpr double kLevelAim = 0.005;  // of the grip force asked for
constexpr int kMostSettlingSteps = 120;
constexpr int kUsualSteps = 60;   // not there by then, the search goes on only while it gets nearer
constexpr int kVainSteps = 25;    // without getting nearer: it goes round in circles
constexpr int kLastSteps = 5;     // the same, where the nearest state so far counts as balanced
constexpr double kNothing = 0.1;  // N; less left over is nothing to a hand: the weight of 10 g
constexpr double kOut = 25.0;     // mm; a product that went farther has left the hand
constexpr double kOutTurn = 0.8;  // rad
// Of what is missing to rest, to which the forces that say so are found; and at most.
constexpr double kForcesShare = 0.2, kRoughForces = 0.1;
constexpr double kLostShare = 0.05;  // of the grip force at the start; less is a lost grip

}  // namespace

Settling::Settling(const contact::PreparedHand& hand, const product::Product& product,
                   const Grasp& grasp, const BalanceOptions& options,
                   const contact::ContactOptions& contact)
    : hand_(&hand.hand()),
      options_(&options),
      asked_(options.asked_grip_force(grasp.grip)),
      has_level_(is_power(grasp.grip) || asked_),
      start_{grasp.posture, grasp.product_from_hand},
      state_(start_),
      meeting_(hand.hand(), start_.posture),
      closing_(hand.hand(), grasp),
      mechanics_(hand, product, contact, options.friction, start_) {
  const bool needs_centre = options.load.weight > 0.0 || !options.load.force.isZero(0.0);
  has_load_ = needs_centre || !options.load.torque.isZero(0.0);
  load_ = contact::wrench_of(
      options.load, needs_centre ? geometry::centre_of_volume(product.mesh) : Vec3(Vec3::Zero()));
  // Hooked fingers carry what pulls at them; they don't squeeze.
  const bool is_hook = grasp.grip == Grip::kFixedHook;
  has_level_ = !is_hook && !options.activation && (has_level_ || extra_grip() > 0.0);
}

bool Settling::Misfit::is_near() const {
  return of_product < 0.5 * kBalanced && of_level < kLevelAim;
}

void Settling::add_load(GripVector& residual) const {
  // From the origin of the product frame to the centre of contact in the hand frame.
  const geometry::Rigid3 hand_from_product = state_.product_from_hand.inverse();
  const Vec3 centre = state_.product_from_hand * mechanics_.centre();
  residual.segment<3>(kGripJoints) += load_share_ * (hand_from_product.rotation * load_.force);
  residual.tail<3>() +=
      load_share_ * (hand_from_product.rotation * (load_.moment - centre.cross(load_.force)));
}

/// Moment of the load about the wrist: what the grip itself does there adds up to nothing.
double Settling::wrist_load() const {
  if (!has_load_) return 0.0;
  const geometry::Rigid3 hand_from_product = state_.product_from_hand.inverse();
  return load_share_ * hand::wrist_moment(*hand_, hand_from_product.rotation * load_.force,
                                          hand_from_product.translation,
                                          hand_from_product.rotation * load_.moment);
}

/// People press the harder the heavier a thing is: by what two opposed contacts need to hold the
/// load by friction (Westling & Johansson 1984), N.
double Settling::extra_grip() const {
  return options_->friction > 0.0 ? 0.5 * load_.force.norm() / options_->friction : 0.0;
}

/// What is missing to rest in the state that mechanics_ looks at.
Settling::Misfit Settling::misfit(double grip) const {
  Misfit result;
  result.residual = mechanics_.force();
  result.stiffness = mechanics_.stiffness();
  add_load(result.residual);
  if (has_level_) result.of_level = std::abs(grip / target_ - 1.0);
  result.force = result.residual.segment<3>(kGripJoints).norm();
  result.moment = result.residual.tail<3>().norm();
  result.of_product = std::max(result.force, result.moment / mechanics_.arm()) / grip;
  return result;
}

bool Settling::judge_way(Balance& balance) const {
  const geometry::Rigid3 motion = state_.product_from_hand.inverse() * start_.product_from_hand;
  balance.turned = Eigen::AngleAxisd(motion.rotation).angle();
  balance.moved = moved_.norm();
  return balance.moved > kOut || balance.turned > kOutTurn;
}

void Settling::finish(Balance& balance) {
  const Squeeze grip = mechanics_.grip();
  balance.grip_force = grip.force;
  balance.sum_of_normals = grip.sum_of_normals;
  balance.friction = options_->friction;
  balance.friction_use = mechanics_.friction_use();
  balance.friction_force = mechanics_.friction_force();
  balance.fallbacks = mechanics_.fallbacks();
  hand::HandLoad& load = balance.joint_load.emplace();
  for (int j = 0; j < kGripJoints; ++j) {
    load.digit[j / hand::kDigitDofs][j % hand::kDigitDofs] = mechanics_.force()[j];
  }
  load.wrist = wrist_load();
  judge_way(balance);
}

Balance Settling::run(const Progress& progress) {
  Balance balance;
  double start_grip = 0.0;
  Misfit now;
  struct {
    GripState state;
    Misfit misfit;
    Vec3 moved = Vec3::Zero();
    int step = 0;
  } best;
  bool gives_up = false;  // the best state found is looked at once more
  // Without one asked for, the squeeze of the first state is the goal.
  double accuracy = asked_ ? kRoughForces : kForcesAccuracy;
  best.misfit.of_product = std::numeric_limits<double>::infinity();
  for (int i = 0;; ++i) {
    progress.throw_if_cancelled();
    balance.iterations = i;
    if (!mechanics_.look(state_, accuracy)) {
      balance.status = BalanceStatus::kFailed;
      balance.message = "the contact could not be solved while the grasp came to rest";
      break;
    }
    const double grip = mechanics_.grip().force;
    if (i == 0) {
      start_grip = grip;
      target_ = asked_.value_or(grip + extra_grip());
      if (grip == 0.0) {
        balance.status = BalanceStatus::kNoContact;
        balance.message = "nothing is touched, so nothing can come to rest";
        break;
      }
    }
    const bool is_lost = grip < kLostShare * std::min(start_grip, target_);
    if (is_lost || judge_way(balance)) {
      balance.status = BalanceStatus::kSlipsOut;
      balance.slip = moved_.norm() > 0.0 ? Vec3(moved_.normalized()) : Vec3(Vec3::UnitY());
      balance.message = balance.turned > kOutTurn && balance.moved < kOut
                            ? fmt::format("turns by more than {:.0f} degrees in the hand",
                                          kOutTurn * geometry::kDegreesPerRadian)
                            : "slips out, towards " + way_words(*hand_, *balance.slip);
      break;
    }

    // People take hold before they lift.
    load_share_ =
        has_load_ && has_level_ ? std::clamp((grip / target_ - 0.5) / 0.45, 0.0, 1.0) : 1.0;
    now = misfit(grip);
    balance.residual_force = now.force;
    balance.residual_moment = now.moment;
    balance.residual_share = now.of_product;
    const bool is_there = now.of_product < options_->aim && now.of_level < kLevelAim;
    if (is_there && accuracy > kForcesAccuracy) {
      accuracy = kForcesAccuracy;  // the same state again
      continue;
    }
    if (is_there || gives_up) {
      balance.status = now.of_product < kBalanced || now.of_product * grip < kNothing
                           ? BalanceStatus::kBalanced
                           : BalanceStatus::kNotConverged;
      break;
    }
    if (now.sum() < best.misfit.sum()) best = {state_, now, moved_, i};
    progress.update(std::min(1.0, static_cast<double>(i) / kMostSettlingSteps),
                    "letting the grasp come to rest");
    accuracy = std::clamp(kForcesShare * now.sum(), kForcesAccuracy, kRoughForces);
    gives_up = i >= kMostSettlingSteps || (i >= kUsualSteps && i - best.step >= kVainSteps) ||
               (best.misfit.is_near() && i - best.step >= kLastSteps);
    if (!gives_up) {
      const double missing = (target_ / grip - 1.0) * mechanics_.grip().sum_of_normals;
      closing_.is_empty() ? step(now, missing) : step_fingertips(now, missing);
    } else {
      accuracy = kForcesAccuracy;
      state_ = best.state;
      moved_ = best.moved;
    }
  }
  if (balance.status == BalanceStatus::kBalanced && load_share_ < 1.0) {
    balance.status = BalanceStatus::kSlipsOut;
    const Vec3 pull = state_.product_from_hand.rotation.conjugate() * load_.force;
    if (pull.norm() > 0.0) balance.slip = pull.normalized();
    balance.message = fmt::format(
        "slips out under its load: the hand reaches a grip force of {:.0f} N, "
        "{:.0f} N are needed",
        mechanics_.grip().force, target_);
  }
  if (balance.status == BalanceStatus::kBalanced) {
    balance.message =
        fmt::format("in balance at a grip force of {:.0f} N", mechanics_.grip().force);
    if (now.of_level > 0.05) {
      balance.message +=
          fmt::format("; {:.0f} N were requested, which the hand doesn't reach", target_);
    }
  } else if (balance.status == BalanceStatus::kNotConverged) {
    balance.message = fmt::format("not in balance after {} steps: ", balance.iterations) +
                      fmt::format("{:.1f} N are left over at a grip force of {:.0f} N",
                                  balance.residual_force, mechanics_.grip().force);
  }
  finish(balance);
  return balance;
}

}  // namespace palmar::grasp
