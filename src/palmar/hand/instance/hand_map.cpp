// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/instance/hand_map.h"

#include <cmath>

namespace palmar::hand {
namespace {

Vec3 mapped_displacement(const CmcLimit& limit, const Eigen::Matrix3d& stretch) {
  const Eigen::AngleAxisd turn(limit.q);
  constexpr double kLeastTurn = 1e-6;  // rad; below it nothing turns and t is all there is
  if (std::abs(turn.angle()) < kLeastTurn) return stretch * limit.t;
  const Vec3& axis = turn.axis();
  const Vec3 along = axis.dot(limit.t) * axis;
  const Vec3 across = limit.t - along;
  // In the plane perpendicular to the axis (I - q) is a turn by (pi - angle) / 2 the other way and
  // a stretch by 2 sin(angle / 2): a = (t + cot(angle / 2) axis x t) / 2.
  const Vec3 arm = 0.5 * (across + axis.cross(across) / std::tan(0.5 * turn.angle()));
  const Vec3 stretched = stretch * arm;
  return stretched - limit.q * stretched + stretch * along;
}

}  // namespace

Skeleton mapped_skeleton(const Skeleton& skeleton, const HandMap& map) {
  Skeleton result = skeleton;
  for (Joint& joint : result.joints) {
    const Eigen::Matrix3d stretch = map.palm_stretch(joint.centre);
    const Vec3 before = joint.centre;
    joint.centre = map.joint(joint.id);
    for (JointDof& dof : joint.dofs) {
      // The foot of the axis stretches, as in the limit postures: its line stays the one they turn
      // about.
      const Vec3 arm = dof.centre - before;
      const Vec3 along = dof.axis.dot(arm) * dof.axis;
      dof.centre =
          joint.centre + stretch * (arm - along) + dof.axis.dot(stretch * along) * dof.axis;
    }
  }
  ThumbCmc& cmc = result.thumb_cmc;
  const Eigen::Matrix3d stretch = map.palm_stretch(skeleton.joint(JointId::kThumbCmc).centre);
  for (CmcLimit* limit : {&cmc.flexion, &cmc.extension, &cmc.abduction, &cmc.adduction}) {
    limit->t = mapped_displacement(*limit, stretch);
  }
  for (int f = 0; f < kFingerCount; ++f) {
    result.fingertips[f] = map.fingertip(static_cast<Finger>(f));
  }
  return result;
}

Hand mapped(const Hand& hand, const HandMap& map) {
  Hand result = hand;
  result.skin.vertices = map.skin();
  result.skeleton = mapped_skeleton(hand.skeleton, map);
  for (JointWeights& weights : result.weights) {
    for (std::size_t k = 0; k < weights.bulge.size(); ++k) {
      if (weights.bulge[k].isZero(0.0)) continue;
      weights.bulge[k] = map.skin_stretch(weights.vertex[k]) * weights.bulge[k];
    }
  }
  ThumbBallCorrection& ball = result.thumb_ball;
  if (!ball.marker.empty()) {
    Vec3 middle = Vec3::Zero();
    for (const Vec3& marker : ball.marker) middle += marker;
    middle /= static_cast<double>(ball.marker.size());
    const Eigen::Matrix3d stretch = map.palm_stretch(middle);
    ball.beta /= std::pow(stretch.determinant(), 2.0 / 3.0);
    for (Vec3& marker : ball.marker) marker = map.in_palm(marker);
    for (std::vector<Vec3>& coefficient : ball.coefficient) {
      for (Vec3& d : coefficient) d = stretch * d;
    }
  }
  for (std::size_t b = 0; b < result.bones.size(); ++b) {
    result.bones[b].mesh.vertices = map.bone(static_cast<int>(b));
  }
  return result;
}

}  // namespace palmar::hand
