// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/equilibrium/thumb_meeting.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace palmar::grasp {
namespace {

constexpr double kPulps = 4.0, kPulpForce = 2.0;  // mm, N
constexpr double kPulpPower = 4.0;

}  // namespace

ThumbPress thumb_press(const hand::Skeleton& skeleton, const hand::Posture& posture,
                       const RoundCone& thumb, const RoundCone& finger, double overlap) {
  ThumbPress press;
  press.finger = finger.finger;
  press.overlap = overlap;
  if (overlap > 0.0) {
    press.force = kPulpForce * std::pow(overlap / kPulps, kPulpPower);
    press.stiffness = kPulpPower * press.force / overlap;
  }
  const ConeContact contact = contact_of(thumb, finger);
  // Bodies: a finger's MCP has one without bone.
  for (const auto& [cone, body, sense] :
       {std::tuple{&thumb, thumb.level + 1, -1.0}, {&finger, finger.level + 1, 1.0}}) {
    const hand::PosedDigit digit = hand::pose_digit(skeleton, cone->finger, posture);
    const int first = hand::kDigitDofs * static_cast<int>(cone->finger);
    for (int k = 0; k < hand::kDigitDofs; ++k) {
      press.moment[first + k] = sense * digit.velocity(k, body, contact.point).dot(contact.normal);
    }
  }
  return press;
}

ThumbMeeting::ThumbMeeting(const hand::Hand& hand, const hand::Posture& start)
    : hand_(&hand), cones_(hand), start_(cones_.posed(hand.skeleton, start)) {}

std::vector<ThumbPress> ThumbMeeting::presses(const hand::Posture& posture) const {
  std::vector<ThumbPress> presses;
  const std::vector<RoundCone> cones = cones_.posed(hand_->skeleton, posture);
  for (std::size_t a = 0; a < cones.size(); ++a) {
    if (cones[a].finger != hand::Finger::kThumb || cones[a].level == 0) continue;
    for (std::size_t b = 0; b < cones.size(); ++b) {
      if (cones[b].finger == hand::Finger::kThumb || cones[b].level == 0) continue;
      const double more =
          overlap(cones[a], cones[b]) - std::max(0.0, overlap(start_[a], start_[b]));
      if (more <= 0.0) continue;
      presses.push_back(thumb_press(hand_->skeleton, posture, cones[a], cones[b], more));
    }
  }
  return presses;
}

}  // namespace palmar::grasp
