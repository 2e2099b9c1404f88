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

constexpr double kEased = 0.1;        // rad, over which a range begins to shrink, and ends to
constexpr double kLongestRise = 8.0;  // e-folds of a ligament's moment, beyond which it stays

// In the order of the digit's angles.
constexpr Eigen::Index kMcp = 0, kSpread = 1, kPip = 2, kDip = 3;

/// A value with its first and second derivative.
struct Curve {
  double value = 0.0, slope = 0.0, bend = 0.0;
};

/// max(0, x), eased about 0.
Curve ramp(double x) {
  if (x <= -kEased) return {};
  if (x >= kEased) return {x, 1.0, 0.0};
  const double t = x + kEased;
  return {t * t / (4.0 * kEased), t / (2.0 * kEased), 1.0 / (2.0 * kEased)};
}

/// Share of the range of abduction that is left at a flexion.
Curve spread_left(double flexion, double none) {
  const Curve begins = ramp(flexion), ends = ramp(flexion - none);
  return {1.0 - (begins.value - ends.value) / none, (ends.slope - begins.slope) / none,
          (ends.bend - begins.bend) / none};
}

/// Ligaments at one end of the range of angle k, `sense` +1: the lower one. The end lies at a share
/// of `end` that flexion of the MCP changes; the energy is M r exp(sense (end - angle) / r) less
/// that at angle 0, whose share in flexion the measured moments have.
void add_end(Eigen::Index k, double angle, double end, const Curve& share, double sense,
             const LigamentModel& model, PassiveMoments& passive) {
  const double at = share.value * end;
  const double rise = std::min(kLongestRise, sense * (at - angle) / model.stop_rise);
  const double moment = model.stop_moment * std::exp(rise);
  const double rate = rise < kLongestRise ? moment / model.stop_rise : 0.0;
  passive.moment[k] += sense * moment;
  passive.stiffness(k, k) += rate;
  if (share.slope == 0.0) return;
  const double at_rest = model.stop_moment * std::exp(sense * at / model.stop_rise);
  const double end_rate = end * share.slope;
  passive.moment[kMcp] -= sense * (moment - at_rest) * end_rate;
  passive.stiffness(kMcp, kMcp) += (rate - at_rest / model.stop_rise) * end_rate * end_rate +
                                   sense * (moment - at_rest) * end * share.bend;
  passive.stiffness(k, kMcp) -= rate * end_rate;
  passive.stiffness(kMcp, k) -= rate * end_rate;
}

}  // namespace

PassiveMoments passive_moments(const Skeleton& skeleton, Finger finger, const Posture& posture,
                               const LigamentModel& ligaments) {
  PassiveMoments passive;
  const bool is_finger = finger != Finger::kThumb;
  const std::array<Dof, kDigitDofs> dofs = digit_dofs(finger);
  for (Eigen::Index k = 0; k < kDigitDofs; ++k) {
    const JointDof& dof = skeleton.dof(dofs[static_cast<std::size_t>(k)]);
    const double angle = posture[dof.dof];
    const Curve share = is_finger && k == kSpread
                            ? spread_left(posture[dofs[kMcp]], ligaments.no_abduction)
                            : Curve{.value = 1.0};
    add_end(k, angle, dof.lower, share, 1.0, ligaments, passive);
    if (is_finger && is_flexion(dof.dof)) continue;  // rises below
    add_end(k, angle, dof.upper, share, -1.0, ligaments, passive);
  }
  if (!is_finger) return passive;
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
