// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/equilibrium/thumb_meeting.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "palmar/core/enum_index.h"

namespace palmar::grasp {
namespace {

constexpr double kPulps = 4.0, kPulpForce = 1.0;  // mm, N
constexpr double kPulpPower = 4.0;
constexpr std::array kAlong{0.1, 0.3, 0.5, 0.7, 0.9};  // a phalanx of the thumb
constexpr double kStep = 1e-4;                         // rad; of differences

Vec3 place_on(const RoundCone& cone, double along) { return cone.a + along * (cone.b - cone.a); }

double overlap_at(const RoundCone& thumb, double along, const RoundCone& finger) {
  const double radius = thumb.radius_a + along * (thumb.radius_b - thumb.radius_a);
  return radius - distance_to(finger, place_on(thumb, along));
}

}  // namespace

ThumbMeeting::ThumbMeeting(const hand::Hand& hand, const hand::Posture& start)
    : hand_(&hand), cones_(hand) {
  const std::vector<RoundCone> cones = cones_.posed(hand.skeleton, start);
  for (std::size_t a = 0; a < cones.size(); ++a) {
    if (cones[a].finger != hand::Finger::kThumb || cones[a].level == 0) continue;
    for (std::size_t b = 0; b < cones.size(); ++b) {
      if (cones[b].finger == hand::Finger::kThumb || cones[b].level == 0) continue;
      for (const double along : kAlong) {
        places_.push_back({a, b, along, std::max(0.0, overlap_at(cones[a], along, cones[b]))});
      }
    }
  }
}

std::vector<ThumbPress> ThumbMeeting::presses(const hand::Posture& posture) const {
  std::vector<ThumbPress> presses;
  const std::vector<RoundCone> cones = cones_.posed(hand_->skeleton, posture);
  std::array<std::optional<hand::PosedDigit>, hand::kFingerCount> digit;
  const auto add_moments = [&](const RoundCone& cone, const Vec3& at, const Vec3& push,
                               ThumbPress& press) {
    const std::size_t f = index_of(cone.finger);
    if (!digit[f]) digit[f] = hand::pose_digit(hand_->skeleton, cone.finger, posture);
    for (int k = 0; k < hand::kDigitDofs; ++k) {
      // A finger's MCP has a body without bone, the thumb a metacarpal that moves.
      press.moment[hand::kDigitDofs * static_cast<int>(f) + k] =
          digit[f]->velocity(k, cone.level + 1, at).dot(push);
    }
  };
  for (const Place& place : places_) {
    const RoundCone &thumb = cones[place.thumb], &finger = cones[place.finger];
    const double more = overlap_at(thumb, place.along, finger) - place.at_start;
    if (more <= 0.0) continue;
    ThumbPress press{.finger = finger.finger, .overlap = more};
    press.force = kPulpForce * std::pow(more / kPulps, kPulpPower);
    press.stiffness = kPulpPower * press.force / more;
    const Vec3 at = place_on(thumb, place.along);
    const Vec3 push = distance_from(finger, at).away;
    add_moments(thumb, at, push, press);
    add_moments(finger, at, -push, press);
    presses.push_back(press);
  }
  return presses;
}

GripMatrix ThumbMeeting::stiffness(const hand::Posture& posture) const {
  const auto moments = [&](const hand::Posture& at) {
    GripVector sum = GripVector::Zero();
    for (const ThumbPress& press : presses(at)) sum += press.force * press.moment;
    return sum;
  };
  const GripVector here = moments(posture);
  GripMatrix result = GripMatrix::Zero();
  if (here.isZero(0.0)) return result;
  for (int j = 0; j < kGripJoints; ++j) {
    hand::Posture turned = posture;
    turned[grip_dof(j)] += kStep;
    result.col(j) = (here - moments(turned)) / kStep;
  }
  return result;
}

}  // namespace palmar::grasp
