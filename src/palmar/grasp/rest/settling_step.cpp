// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
// Steps of the search for rest.
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "palmar/core/enum_index.h"
#include "palmar/grasp/rest/settling.h"
#include "palmar/hand/skeleton.h"

namespace palmar::grasp {
namespace {

constexpr double kLongestStep = 4.0;  // mm, of any skin or of the product
constexpr double kReach = 40.0;       // mm; arm by which turns are counted as way
constexpr double kLeastRelaxation = 0.3;
constexpr double kLongestPress = 0.7;  // mm, of fingertips in one step
constexpr double kLongestTurn = 0.06;  // rad, of what they hold
// mm; pulp of thumb and finger pressed together, 2 mm each: stiff ones close no further; our choice
constexpr double kPulpGive = 4.0;
constexpr double kSoftest = 0.02;  // of the mean stiffness of joints and of the product: the least

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Stiffness of the product's own coordinates, no way softer than a share of the mean.
Matrix6 softened(const GripMatrix& stiffness) {
  Matrix6 k = stiffness.bottomRightCorner<6, 6>();
  for (const int begin : {0, 3}) {
    k.diagonal().segment<3>(begin).array() +=
        kSoftest * k.diagonal().segment<3>(begin).mean() + 1e-9;
  }
  return k;
}

}  // namespace

/// One Newton step towards rest, and by a common closing of all loaded joints that flex towards the
/// grip force asked for:
///
///     stiffness dx = residual,    squeeze . dx = missing sum of normal forces.
void Settling::step(const Misfit& misfit, double missing) {
  const Eigen::PartialPivLU<Matrix6> factor(softened(misfit.stiffness));
  const auto solved = [&](const GripVector& right) {
    GripVector whole = GripVector::Zero();
    whole.tail<6>() = factor.solve(Vector6(right.tail<6>()));
    return whole;
  };
  GripVector way = solved(misfit.residual);
  if (has_level_) {
    GripVector closing = GripVector::Zero();
    std::array<bool, hand::kFingerCount> has_met{};
    for (const ThumbPress& press : meeting_.presses(state_.posture)) {
      if (press.overlap > kPulpGive) has_met[index_of(press.finger)] = true;
    }
    for (int j = 0; j < kGripJoints; ++j) {
      const bool closes = hand::is_flexion(grip_dof(j)) && mechanics_.is_loaded()[j];
      if (closes && !has_met[index_of(grip_finger(j))]) closing[j] = 1.0;
    }
    const GripVector gain = solved(-(misfit.stiffness * closing)) + closing;
    const double rate = mechanics_.squeeze().dot(gain);
    if (rate > 1e-12) way += (missing - mechanics_.squeeze().dot(way)) / rate * gain;
  }
  double longest = std::max(way.segment<3>(kGripJoints).norm(), kReach * way.tail<3>().norm());
  for (int j = 0; j < kGripJoints; ++j) longest = std::max(longest, kReach * std::abs(way[j]));
  way *= share_of(way, longest);
  for (int j = 0; j < kGripJoints; ++j) {
    const hand::JointDof& dof = hand_->skeleton.dof(grip_dof(j));
    double& angle = state_.posture[dof.dof];
    angle = std::clamp(angle + way[j], std::min(dof.lower, angle), std::max(dof.upper, angle));
  }
  move_product(way.segment<3>(kGripJoints), way.tail<3>());
}

/// How much of a step is taken; `longest` is the longest way that something goes in it, mm.
double Settling::share_of(const GripVector& way, double longest) {
  // Going to and fro says that forces change faster than the stiffness says: shorter steps.
  GripVector scaled = way;
  scaled.head<kGripJoints>() *= kReach;
  scaled.tail<3>() *= kReach;
  const double cosine = scaled.dot(last_way_) / (scaled.norm() * last_way_.norm() + 1e-300);
  relaxation_ = std::clamp(relaxation_ * (cosine < -0.2  ? 0.6
                                          : cosine > 0.2 ? 1.25
                                                         : 1.0),
                           kLeastRelaxation, 1.0);
  last_way_ = scaled;
  return relaxation_ * std::min(1.0, kLongestStep / longest);
}

void Settling::move_product(const Vec3& shift, const Vec3& turn) {
  geometry::Rigid3 motion;
  if (turn.norm() > 0.0) {
    motion = geometry::Rigid3::about_axis(turn.normalized(), mechanics_.centre(), turn.norm());
  }
  motion.translation += shift;
  moved_ += shift;
  state_.product_from_hand = state_.product_from_hand * motion.inverse();
}

/// The same for a precision grip: joints are held stiff, and fingertips go straight into the
/// product, all alike, until the grip force is there.
void Settling::step_fingertips(const Misfit& misfit, double missing) {
  const Matrix6 k = softened(misfit.stiffness);
  const Eigen::PartialPivLU<Matrix6> factor(k);
  const Vector6 squeeze = mechanics_.squeeze().tail<6>();
  Vector6 force = misfit.residual.tail<6>();
  hand::Posture rate;
  double level = 0.0;
  if (has_level_) {
    rate = closing_.rate(state_.posture, state_.product_from_hand, missing > 0.0 ? 1.0 : -1.0);
    const GripMechanics::Closing closing = mechanics_.closing(state_.posture, rate);
    const double per_mm = closing.squeeze + squeeze.dot(factor.solve(closing.force));
    if (per_mm > 1e-12) {
      level = std::clamp((missing - squeeze.dot(factor.solve(force))) / per_mm, -kLongestPress,
                         kLongestPress);
      force += level * closing.force;
    }
  }
  // A thing between two fingertips turns much more easily than it moves: the turn is limited by
  // itself, and the shift is that which suits it.
  Vector6 way = factor.solve(force);
  const double turn = way.tail<3>().norm();
  way.tail<3>() *= std::min(1.0, kLongestTurn / std::max(turn, 1e-12));
  const Eigen::PartialPivLU<Eigen::Matrix3d> shift(k.topLeftCorner<3, 3>());
  way.head<3>() = shift.solve(Vec3(force.head<3>() - k.topRightCorner<3, 3>() * way.tail<3>()));
  GripVector whole = GripVector::Zero();
  whole.tail<6>() = way;
  const double share = share_of(whole, std::max(way.head<3>().norm(), 1e-12));
  for (int d = 0; d < hand::kDofCount; ++d) {
    const hand::JointDof& dof = hand_->skeleton.dof(static_cast<hand::Dof>(d));
    double& angle = state_.posture[dof.dof];
    angle = std::clamp(angle + share * level * rate[dof.dof], std::min(dof.lower, angle),
                       std::max(dof.upper, angle));
  }
  move_product(share * way.head<3>(), share * way.tail<3>());
}

}  // namespace palmar::grasp
