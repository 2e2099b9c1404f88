// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/tendons/joint_limits.h"

#include <algorithm>
#include <cmath>

#include "palmar/core/enum_index.h"
#include "palmar/geometry/degrees.h"

namespace palmar::hand {
namespace {

// Deshpande et al. 2012, subject M2: N mm, 1/rad, rad.
constexpr double kOpening = 12.7, kOpeningRate = 0.031 / geometry::kDegree,
                 kOpeningFrom = 47.39 * geometry::kDegree;
constexpr double kClosing = 18.3, kClosingRate = 0.07 / geometry::kDegree,
                 kClosingFrom = 58.97 * geometry::kDegree;
constexpr double kIndexMcpEnd = 84.7 * geometry::kDegree;  // Latz et al. 2019

constexpr double kDipPerPip = 2.0 / 3.0;
constexpr double kCouplingFree = 10.0 * geometry::kDegree;  // rad
constexpr double kCouplingSets = 5.0 * geometry::kDegree;   // rad; about there it sets in
constexpr double kCouplingStiffness = 1500.0;               // N mm/rad

// In the order of the digit's angles.
constexpr Eigen::Index kMcp = 0, kPip = 2, kDip = 3;

}  // namespace

PassiveMoments passive_moments(const Skeleton& skeleton, Finger finger, const Posture& posture) {
  PassiveMoments passive;
  if (finger == Finger::kThumb) return passive;
  const std::array<Dof, kDigitDofs> dofs = digit_dofs(finger);
  for (const Eigen::Index k : {kMcp, kPip, kDip}) {
    const Dof dof = dofs[static_cast<std::size_t>(k)];
    const double beyond = posture[dof] - skeleton.dof(dof).upper + kIndexMcpEnd;
    const double closed = kClosing * std::exp(kClosingRate * (beyond - kClosingFrom));
    if (k == kMcp || beyond > kClosingFrom) {
      passive.moment[k] -= closed - kClosing;
      passive.stiffness(k, k) += kClosingRate * closed;
    }
    if (k != kMcp) continue;
    const double opened = kOpening * std::exp(-kOpeningRate * (beyond - kOpeningFrom));
    passive.moment[k] += opened - kOpening;
    passive.stiffness(k, k) += kOpeningRate * opened;
  }
  const double off = posture[dofs[kDip]] - kDipPerPip * posture[dofs[kPip]];
  // Beyond what is free, without a kink where that ends.
  const double beyond = std::abs(off) - kCouplingFree;
  if (beyond <= -kCouplingSets) return passive;
  const double share = std::min(1.0, (beyond + kCouplingSets) / (2.0 * kCouplingSets));
  const double excess = std::copysign(share < 1.0 ? kCouplingSets * share * share : beyond, off);
  Eigen::Vector4d along = Eigen::Vector4d::Zero();
  along[kDip] = 1.0;
  along[kPip] = -kDipPerPip;
  passive.moment -= kCouplingStiffness * excess * along;
  passive.stiffness += kCouplingStiffness * share * along * along.transpose();
  return passive;
}

int stop_of(const Skeleton& skeleton, Dof which, const Posture& posture, const JointStops& stops) {
  if (!stops.is_on) return 0;
  const Finger finger = finger_of(which);
  const bool is_finger = finger != Finger::kThumb;
  const std::array<Dof, kDigitDofs> dofs = digit_dofs(finger);
  if (is_finger && which == dofs[1] && posture[dofs[0]] >= stops.tight_mcp_flexion) return 2;
  const JointDof& dof = skeleton.dof(which);
  const bool rises = is_finger && is_flexion(which);
  if (!rises && posture[which] >= dof.upper - stops.margin) return -1;
  if (posture[which] <= dof.lower + stops.margin) return 1;
  return 0;
}

}  // namespace palmar::hand
