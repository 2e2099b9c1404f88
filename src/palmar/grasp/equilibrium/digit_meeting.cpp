// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/equilibrium/digit_meeting.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "palmar/core/enum_index.h"

namespace palmar::grasp {
namespace {

constexpr double kPulps = 4.0, kPulpForce = 1.0;  // mm, N
constexpr double kPulpPower = 4.0;
constexpr std::array kAlong{0.1, 0.3, 0.5, 0.7, 0.9};  // a phalanx
constexpr int kFingertip = 3;                          // its level
constexpr double kStep = 1e-4;                         // rad; of differences

Vec3 place_on(const RoundCone& cone, double along) { return cone.a + along * (cone.b - cone.a); }

double overlap_at(const RoundCone& first, double along, const RoundCone& second) {
  const double radius = first.radius_a + along * (first.radius_b - first.radius_a);
  return radius - distance_to(second, place_on(first, along));
}

}  // namespace

DigitMeeting::DigitMeeting(const hand::Hand& hand, const hand::Posture& apart)
    : hand_(&hand), cones_(hand) {
  const std::vector<RoundCone> cones = cones_.posed(hand.skeleton, apart);
  const auto meet = [](const RoundCone& a, const RoundCone& b) {
    const bool is_thumb = a.finger == hand::Finger::kThumb;
    if (a.level == 0) return false;
    if (b.level == 0) return !is_thumb && a.level == kFingertip;
    return is_thumb ? b.finger != a.finger : index_of(b.finger) == index_of(a.finger) + 1;
  };
  for (std::size_t a = 0; a < cones.size(); ++a) {
    for (std::size_t b = 0; b < cones.size(); ++b) {
      if (!meet(cones[a], cones[b])) continue;
      for (const double along : kAlong) {
        places_.push_back({a, b, along, std::max(0.0, overlap_at(cones[a], along, cones[b]))});
      }
    }
  }
}

std::vector<DigitPress> DigitMeeting::presses(const hand::Posture& posture) const {
  std::vector<DigitPress> presses;
  const std::vector<RoundCone> cones = cones_.posed(hand_->skeleton, posture);
  std::array<std::optional<hand::PosedDigit>, hand::kFingerCount> digit;
  const auto add_moments = [&](const RoundCone& cone, const Vec3& at, const Vec3& push,
                               DigitPress& press) {
    if (cone.level == 0 && cone.finger != hand::Finger::kThumb) return;  // the palm stands fast
    const std::size_t f = index_of(cone.finger);
    if (!digit[f]) digit[f] = hand::pose_digit(hand_->skeleton, cone.finger, posture);
    for (int k = 0; k < hand::kDigitDofs; ++k) {
      // A finger's MCP has a body without bone, the thumb a metacarpal that moves.
      press.moment[hand::kDigitDofs * static_cast<int>(f) + k] =
          digit[f]->velocity(k, cone.level + 1, at).dot(push);
    }
  };
  for (const Place& place : places_) {
    const RoundCone &first = cones[place.first], &second = cones[place.second];
    const double more = overlap_at(first, place.along, second) - place.apart;
    if (more <= 0.0) continue;
    DigitPress press{.overlap = more};
    press.force = kPulpForce * std::pow(more / kPulps, kPulpPower);
    press.stiffness = kPulpPower * press.force / more;
    const Vec3 at = place_on(first, place.along);
    const Vec3 push = distance_from(second, at).away;
    add_moments(first, at, push, press);
    add_moments(second, at, -push, press);
    presses.push_back(press);
  }
  return presses;
}

GripMatrix DigitMeeting::stiffness(const hand::Posture& posture) const {
  const auto moments = [&](const hand::Posture& at) {
    GripVector sum = GripVector::Zero();
    for (const DigitPress& press : presses(at)) sum += press.force * press.moment;
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
