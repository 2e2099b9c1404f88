// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/page/friction_words.h"

#include <cmath>

#include "palmar/geometry/degrees.h"
#include "palmar/report/words/plain_words.h"

namespace palmar::report {

namespace {

/// The one or two main directions of a motion, in words of the hand.
std::string direction_words(const Vec3& in_hand, hand::Side side) {
  constexpr double kMain = 0.45;  // share of a direction that is worth naming
  const double radial = side == hand::Side::kLeft ? -in_hand.x() : in_hand.x();
  const double length = in_hand.norm();
  if (!(length > 0.0)) return "nowhere";
  std::string words;
  const auto name = [&](double share, const char* forwards, const char* backwards) {
    if (std::abs(share) < kMain * length) return;
    if (!words.empty()) words += " and ";
    words += share > 0.0 ? forwards : backwards;
  };
  name(radial, "towards the thumb's side", "towards the little finger's side");
  name(in_hand.y(), "towards the fingertips", "towards the wrist");
  name(in_hand.z(), "out of the palm", "into the palm");
  return words;
}

std::string load_words(const contact::FrictionResult& friction) {
  const double force = friction.load.force.norm();
  const double moment =
      (friction.load.moment - friction.mass_centre.cross(friction.load.force)).norm();
  if (force > 0.0 && moment > 1e-9 * force) {
    return short_number(force) + " N with " + short_number(moment) +
           " N mm about the centre of mass";
  }
  return force > 0.0 ? short_number(force) + " N" : short_number(moment) + " N mm";
}

std::string motion_words(const contact::FrictionResult& friction) {
  const double turn = friction.motion.rotation.norm() * geometry::kDegreesPerRadian;
  return short_number(friction.motion.translation.norm(), 2) + " mm and turns by " +
         short_number(turn, 2) + "°";
}

}  // namespace

std::string friction_verdict(const hand::Hand& hand, const study::Assessment& assessment) {
  const contact::FrictionResult& friction = assessment.friction;
  const std::string with = "With a friction coefficient of " +
                           short_number(assessment.options.friction.coefficient, 2) + " ";
  std::string rest = " The pressures' own sum, " + short_number(friction.grip.force.norm()) +
                     " N, is not part of this balance: it is taken as held by the grip.";
  if (assessment.balance.status == grasp::BalanceStatus::kSlipsOut) {
    rest = " But the grasp itself does not come to rest: the product " +
           assessment.balance.message + "; this is of the hand as it was closed.";
  } else if (assessment.balance.status == grasp::BalanceStatus::kBalanced &&
             friction.status == contact::FrictionStatus::kSlips) {
    rest =
        " In the grasp at rest the pressures carry a part of the load, which this margin of "
        "friction alone leaves out: it holds, with nothing to spare by friction.";
  }
  switch (friction.status) {
    case contact::FrictionStatus::kOff:
      return {};
    case contact::FrictionStatus::kNoContact:
      return "Nothing is touched, so friction holds nothing.";
    case contact::FrictionStatus::kNotConverged:
      return "Friction: " + friction.message + ".";
    case contact::FrictionStatus::kHeld:
      if (!friction.load_factor) {
        return with + "nothing is to be held: no weight and no force was given.";
      }
      return with + "the load of " + load_words(friction) + " is held; friction could hold " +
             short_number(*friction.load_factor) + " times as much. " +
             (friction.message.empty() ? "Until the skin has taken it up, the product moves by " +
                                             motion_words(friction) + ", and " +
                                             short_number(100.0 * friction.slipping_share, 2) +
                                             " % of the loaded skin slips a little."
                                       : "But " + friction.message + ".") +
             rest;
    case contact::FrictionStatus::kSlips:
      break;
  }
  const Quat hand_from_product = assessment.grasp.product_from_hand.rotation.conjugate();
  const double share = 100.0 * friction.load_factor.value_or(0.0);
  const double turn = friction.slip.rotation.norm() * geometry::kDegreesPerRadian;
  return with + "the product slips: friction holds at most " + short_number(share, 2) +
         " % of the load of " + load_words(friction) + ". Its centre of mass begins to move " +
         direction_words(hand_from_product * friction.slip.translation, hand.side) +
         ", and it turns by " + short_number(turn, 2) + "° while its fastest contact moves 1 mm." +
         rest;
}

}  // namespace palmar::report
