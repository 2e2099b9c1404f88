// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/power/finger_motion.h"

#include <cmath>

#include "palmar/core/enum_index.h"

namespace palmar::grasp {
namespace {

Vec3 rotation_vector(const Quat& q) {
  const Eigen::AngleAxisd turn(q);
  return turn.angle() * turn.axis();
}

Eigen::Matrix3d cross_matrix(const Vec3& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

// d exp(w) = exp(J dw) exp(w): the left Jacobian of the rotation group.
Eigen::Matrix3d left_jacobian(const Vec3& w) {
  const double angle = w.norm();
  const Eigen::Matrix3d k = cross_matrix(w);
  if (angle < 1e-6) return Eigen::Matrix3d::Identity() + 0.5 * k;
  const double a2 = angle * angle;
  return Eigen::Matrix3d::Identity() + (1.0 - std::cos(angle)) / a2 * k +
         (angle - std::sin(angle)) / (a2 * angle) * k * k;
}

// s of cmc_share() per radian, on the side where the joint stands.
double share_rate(const hand::JointDof& dof, double share) {
  const double up = dof.upper - dof.reference, down = dof.reference - dof.lower;
  const bool is_up = share > 0.0 || (share == 0.0 && up >= down);
  const double limit = is_up ? up : down;
  return limit > 0.0 ? 1.0 / limit : 0.0;
}

// s_fe and s_aa carry their sign; past zero the other limit posture takes over with |s|.
const hand::CmcLimit& limit_of(const hand::CmcLimit& up, const hand::CmcLimit& down,
                               const hand::JointDof& dof, double share) {
  const bool is_up =
      share > 0.0 || (share == 0.0 && dof.upper - dof.reference >= dof.reference - dof.lower);
  return is_up ? up : down;
}

}  // namespace

FingerMotion::FingerMotion(const hand::Skeleton& skeleton, const hand::Posture& posture)
    : posed_(hand::pose_skeleton(skeleton, posture)) {
  // q = exp(|s_fe| log q_fe + |s_aa| log q_aa), t = |s_fe| t_fe + |s_aa| t_aa about the centre c.
  const hand::CmcShare share = hand::cmc_share(skeleton, posture);
  const hand::JointDof& fe_dof = skeleton.dof(hand::Dof::kThumbCmcFlexion);
  const hand::JointDof& aa_dof = skeleton.dof(hand::Dof::kThumbCmcAbduction);
  const hand::ThumbCmc& cmc = skeleton.thumb_cmc;
  const hand::CmcLimit& fe = limit_of(cmc.flexion, cmc.extension, fe_dof, share.s_fe);
  const hand::CmcLimit& aa = limit_of(cmc.abduction, cmc.adduction, aa_dof, share.s_aa);
  const double fe_sign = &fe == &cmc.flexion ? 1.0 : -1.0;
  const double aa_sign = &aa == &cmc.abduction ? 1.0 : -1.0;
  const Vec3 log_fe = fe_sign * rotation_vector(fe.q), t_fe = fe_sign * fe.t;
  const Vec3 log_aa = aa_sign * rotation_vector(aa.q), t_aa = aa_sign * aa.t;
  const Eigen::Matrix3d jacobian = left_jacobian(share.s_fe * log_fe + share.s_aa * log_aa);
  const Vec3 centre =
      skeleton.joint(hand::JointId::kThumbCmc).centre + share.s_fe * t_fe + share.s_aa * t_aa;
  const double fe_rate = share_rate(fe_dof, share.s_fe);
  const double aa_rate = share_rate(aa_dof, share.s_aa);
  cmc_ = {{hand::Dof::kThumbCmcFlexion, fe_rate * (jacobian * log_fe), centre, fe_rate * t_fe},
          {hand::Dof::kThumbCmcAbduction, aa_rate * (jacobian * log_aa), centre, aa_rate * t_aa}};

  for (int f = 0; f < hand::kFingerCount; ++f) {
    const auto finger = static_cast<hand::Finger>(f);
    const bool is_thumb = finger == hand::Finger::kThumb;
    geometry::Rigid3 proximal = is_thumb ? posed_.thumb_metacarpal : geometry::Rigid3{};
    std::vector<DofMotion> chain = is_thumb ? cmc_ : std::vector<DofMotion>{};
    for (const std::optional<hand::Segment>& segment : hand::segments_of(finger)) {
      if (!segment) continue;
      // A joint's first axis is turned by its later ones: b_from_a = T_n ... T_2 T_1.
      const hand::Joint& joint = skeleton.joint(hand::joint_of(*segment));
      geometry::Rigid3 outer = proximal;
      std::vector<DofMotion> own;
      for (auto dof = joint.dofs.rbegin(); dof != joint.dofs.rend(); ++dof) {
        own.push_back({dof->dof, outer.rotation * dof->axis, outer * dof->centre, Vec3::Zero()});
        outer = outer * geometry::Rigid3::about_axis(dof->axis, dof->centre,
                                                     posture[dof->dof] - dof->reference);
      }
      chain.insert(chain.end(), own.begin(), own.end());
      moving_[index_of(*segment)] = chain;
      proximal = outer;
    }
  }
}

}  // namespace palmar::grasp
