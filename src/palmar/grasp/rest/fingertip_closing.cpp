// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/rest/fingertip_closing.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "palmar/grasp/power/finger_motion.h"
#include "palmar/grasp/power/skin_advance.h"
#include "palmar/grasp/precision/precision_shape.h"

namespace palmar::grasp {
namespace {

constexpr double kDamping = 2.0;         // mm
constexpr double kDepthCoupling = 10.0;  // mm
constexpr double kDipOfPip = 2.0 / 3.0;  // Rijkpema & Girard 1991
constexpr double kAtEndOfRange = 1e-6;   // rad
constexpr double kLeastNormal = 0.5;     // of a unit vector; a fingertip without one has no way

}  // namespace

FingertipClosing::FingertipClosing(const hand::Hand& hand, const Grasp& grasp) : hand_(&hand) {
  if (grasp.fingertips.empty()) return;
  for (const FingertipPoint& tip : fingertips_of(hand, grasp.grip)) {
    for (const FingertipContact& contact : grasp.fingertips) {
      if (contact.finger != tip.finger || contact.normal.norm() < kLeastNormal) continue;
      tips_.push_back({tip.segment, contact.reached, contact.normal});
    }
  }
}

hand::Posture FingertipClosing::rate(const hand::Posture& posture,
                                     const geometry::Rigid3& product_from_hand, double sign) const {
  hand::Posture result;
  const hand::Skeleton& skeleton = hand_->skeleton;
  const FingerMotion motion(skeleton, posture);
  const geometry::Rigid3 hand_from_product = product_from_hand.inverse();
  for (const Tip& tip : tips_) {
    const Vec3 x = hand_from_product * tip.point;
    const Vec3 n = hand_from_product.rotation * tip.normal;
    std::vector<DofMotion> moving = motion.moving(tip.segment);
    // One after the other, joints that would leave their range are held.
    for (;;) {
      const auto m = static_cast<Eigen::Index>(moving.size());
      if (m == 0) break;
      Eigen::Matrix3Xd jacobian(3, m);
      for (Eigen::Index j = 0; j < m; ++j) jacobian.col(j) = moving[j].of_point(x);
      Eigen::MatrixXd system = jacobian.transpose() * jacobian;
      system.diagonal().array() += kDamping * kDamping;
      for (Eigen::Index i = 0; i + 1 < m; ++i) {
        const hand::Finger finger = *hand::finger_of(tip.segment);
        if (finger == hand::Finger::kThumb || moving[i].dof != flexion_of(finger, 1)) continue;
        if (moving[i + 1].dof != flexion_of(finger, 2)) continue;
        Eigen::VectorXd row = Eigen::VectorXd::Zero(m);
        row[i] = -kDipOfPip * kDepthCoupling;
        row[i + 1] = kDepthCoupling;
        system += row * row.transpose();
      }
      const Eigen::VectorXd q = system.ldlt().solve(Eigen::VectorXd(-jacobian.transpose() * n));
      const auto leaves = [&](const DofMotion& one) {
        const hand::JointDof& dof = skeleton.dof(one.dof);
        const double way = sign * q[&one - moving.data()];
        return (way > 0.0 && posture[one.dof] >= dof.upper - kAtEndOfRange) ||
               (way < 0.0 && posture[one.dof] <= dof.lower + kAtEndOfRange);
      };
      const auto held = std::find_if(moving.begin(), moving.end(), leaves);
      if (held != moving.end()) {
        moving.erase(held);
        continue;
      }
      for (Eigen::Index j = 0; j < m; ++j) result[moving[j].dof] = q[j];
      break;
    }
  }
  return result;
}

}  // namespace palmar::grasp
