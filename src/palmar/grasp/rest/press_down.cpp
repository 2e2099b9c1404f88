// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/rest/press_down.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "palmar/grasp/rest/grip_mechanics.h"

namespace palmar::grasp {
namespace {

constexpr double kPressStep = 1.0;        // mm
constexpr double kPressFarthest = 8.0;    // mm either way: more than skin gives
constexpr double kPressTolerance = 5e-3;  // of the force asked for
constexpr int kPressHalvings = 24;

}  // namespace

Balance press_down(const contact::PreparedHand& hand, const product::Product& product, Grasp& grasp,
                   const BalanceOptions& options, const contact::ContactOptions& contact,
                   const Progress& progress) {
  Balance balance;
  balance.friction = options.friction;
  const Vec3 way = grasp.grip == Grip::kFingerPush && !grasp.fingertips.empty()
                       ? Vec3(-grasp.fingertips.front().normal)
                       : Vec3(grasp.product_from_hand.rotation * Vec3::UnitZ());
  const GripState start{grasp.posture, grasp.product_from_hand};
  const std::optional<double> asked = options.asked_grip_force(grasp.grip);
  GripMechanics mechanics(hand, product, contact, options.friction, start);
  double pressed = 0.0, normals = 0.0;
  const auto look = [&](double moved) {
    progress.throw_if_cancelled();
    GripState state = start;
    state.product_from_hand.translation += moved * way;
    ++balance.iterations;
    if (!mechanics.look(state)) return false;
    normals = 0.0;
    for (const contact::RegionContact& region : mechanics.contact().regions)
      normals += region.force;
    Vec3 sum = mechanics.wrench_of(std::nullopt).head<3>();
    for (int f = 0; f < hand::kFingerCount; ++f) {
      sum += mechanics.wrench_of(static_cast<hand::Finger>(f)).head<3>();
    }
    pressed = way.dot(state.product_from_hand.rotation * sum);
    return true;
  };
  const auto finish = [&](double moved, BalanceStatus status) {
    grasp.product_from_hand.translation += moved * way;
    balance.status = status;
    balance.moved = std::abs(moved);
    balance.grip_force = pressed;
    balance.sum_of_normals = normals;
    balance.fallbacks = mechanics.fallbacks();
    return balance;
  };
  if (!look(0.0)) {
    balance.status = BalanceStatus::kFailed;
    balance.message = "the contact could not be solved";
    return balance;
  }
  const char* const what = grasp.grip == Grip::kFingerPush ? "is pushed" : "is rested on";
  if (!asked) {
    balance.message =
        fmt::format("{} with {:.1f} N; what it stands on carries that", what, pressed);
    return finish(0.0, pressed > 0.0 ? BalanceStatus::kSupported : BalanceStatus::kNoContact);
  }
  // Deeper or less deep until the force is between two places.
  const double step = pressed < *asked ? kPressStep : -kPressStep;
  double near = 0.0, here = 0.0;
  while (std::abs(here) < kPressFarthest && (pressed < *asked) == (step > 0.0)) {
    near = here;
    here += step;
    if (!look(here)) break;
  }
  if ((pressed < *asked) == (step > 0.0)) {
    balance.message =
        fmt::format("{} with {:.1f} N; {:.1f} N can't be reached so", what, pressed, *asked);
    return finish(here, pressed > 0.0 ? BalanceStatus::kNotConverged : BalanceStatus::kNoContact);
  }
  double less = step > 0.0 ? near : here, more = step > 0.0 ? here : near;
  double moved = here;
  for (int k = 0; k < kPressHalvings; ++k) {
    moved = 0.5 * (less + more);
    if (!look(moved)) {
      balance.status = BalanceStatus::kFailed;
      balance.message = "the contact could not be solved on the way";
      return balance;
    }
    if (std::abs(pressed - *asked) <= kPressTolerance * *asked) break;
    (pressed < *asked ? less : more) = moved;
  }
  balance.message = fmt::format("{} with {:.1f} N; what it stands on carries that", what, pressed);
  return finish(moved, BalanceStatus::kSupported);
}

}  // namespace palmar::grasp
