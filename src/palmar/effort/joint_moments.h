// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "palmar/contact/contact.h"
#include "palmar/contact/friction/friction.h"
#include "palmar/hand/tendons/digit_pose.h"

namespace palmar::effort {

/// A force on the hand at a place of its skin, hand frame.
struct SkinForce {
  int vertex = 0;             ///< of hand.skin
  Vec3 point = Vec3::Zero();  ///< where it acts in the posture, mm
  Vec3 force = Vec3::Zero();  ///< N
  bool is_by_skin = false;    ///< of other skin of the same hand, not of the product
};

/// What a solved contact does to the hand, one load per loaded vertex: the product pushes with p
/// along its outward normal at the skin after contact; with `friction` minus its tractions (which
/// are those of the skin on the product). Skin on skin, where the contact has it, adds a load on
/// each of the two, of opposite sign.
std::vector<SkinForce> skin_loads(const contact::ContactResult& contact,
                                  const geometry::Rigid3& product_from_hand,
                                  const geometry::DistanceField& product,
                                  const contact::FrictionResult* friction = nullptr);

/// What outside forces do at the joints of one digit.
struct DigitMoments {
  std::array<double, hand::kDigitDofs> moment{};  ///< in the angles' positive sense, N mm
  double force = 0.0;                             ///< sum of |force| of the product on the digit, N
};

/// Moments of `loads` about every axis of the digit in its posture (virtual work): Q_k = sum f .
/// (dx / d angle_k), phalanges as rigid bodies; Q_k > 0 drives the angle up and muscles must hold
/// against it. Skin over the thumb's metacarpal belongs to it by the share with which the CMC moves
/// it (skinning weights). The weight of the hand is left out.
DigitMoments digit_moments(const hand::Hand& hand, const hand::PosedDigit& digit,
                           std::span<const SkinForce> loads);

}  // namespace palmar::effort
