// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/effort/fingertip_force.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>
#include <string>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"

namespace palmar::effort {
namespace {

/// A force along the finger must have a lever of at least this share of the finger's length in the
/// joints, else the answer is rounding.
constexpr double kLeastLever = 0.01;

std::size_t index_of(hand::Finger finger, hand::Tendon tendon) {
  const auto own = hand::tendons_of(finger);
  std::string known;
  for (std::size_t t = 0; t < own.size(); ++t) {
    if (own[t] == tendon) return t;
    known += (t > 0 ? ", " : "") + std::string(name_of(own[t]));
  }
  throw UsageError("the " + std::string(name_of(finger)) + " has no tendon " +
                   std::string(name_of(tendon)) + "; it has " + known);
}

}  // namespace

FingertipForce fingertip_force(const hand::Hand& hand, const hand::DigitTendons& tendons,
                               const hand::Posture& posture, hand::Tendon tendon,
                               double tendon_force) {
  const std::size_t t = index_of(tendons.finger, tendon);
  if (!(tendon_force > 0.0) || tendon_force > kLargestTendonForce) {
    throw UsageError("tendon force is " + std::to_string(tendon_force) +
                     " N; above 0 and at most " + std::to_string(kLargestTendonForce) +
                     " N is allowed");
  }
  const hand::PosedDigit digit = hand::pose_digit(hand.skeleton, tendons.finger, posture);
  const int body = hand::distal_body(tendons.finger);
  const geometry::Rigid3& posed = digit.body[body];
  const Vec3 tip_at_rest = hand.skeleton.fingertips[palmar::index_of(tendons.finger)];

  FingertipForce result;
  result.finger = tendons.finger;
  result.tendon = tendon;
  result.tendon_force = tendon_force;
  result.dof = digit.dof;
  result.moment_arm = hand::moment_arms(tendons.path[t], digit);
  result.point = posed * tip_at_rest;

  const hand::JointDof& last = hand.skeleton.dof(digit.dof.back());
  const Vec3 axis = posed.rotation * last.axis;
  Vec3 along = posed.rotation * (tip_at_rest - last.centre);
  const double length = along.norm();
  along = (along - along.dot(axis) * axis).normalized();

  // Unknowns: force, and moment over the length of the distal phalanx, so that columns compare.
  Eigen::Matrix4d balance;
  Eigen::Vector4d moment;
  for (int k = 0; k < hand::kDigitDofs; ++k) {
    balance.row(k).head<3>() = digit.velocity(k, body, result.point);
    balance(k, 3) = length * digit.twist[k].omega.dot(axis);
    moment[k] = tendon_force * result.moment_arm[k];
  }
  const Eigen::JacobiSVD<Eigen::Matrix4d> svd(balance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (svd.singularValues()[3] < kLeastLever * svd.singularValues()[0]) {
    throw NumericalError("the " + std::string(name_of(tendons.finger)) +
                         " is too straight: a force along it has no lever about any joint, so that "
                         "the force at its tip can't be determined; flex its joints");
  }
  const Eigen::Vector4d solution = svd.solve(moment);
  result.force = solution.head<3>();
  result.moment = solution[3] * length;
  const Vec3 radial = hand.side == hand::Side::kRight ? axis : Vec3(-axis);
  result.force_in_phalanx = {result.force.dot(radial), result.force.dot(along),
                             result.force.dot(axis.cross(along))};
  return result;
}

}  // namespace palmar::effort
