// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/equilibrium/skin_motion.h"

#include <algorithm>

#include "palmar/core/enum_index.h"
#include "palmar/hand/skin/skinning.h"

namespace palmar::grasp {

SkinMotion::SkinMotion(const hand::Hand& hand) : hand_(&hand) {
  for (int j = 0; j < kGripJoints; ++j) {
    is_moved_[j].assign(hand.skin.vertices.size(), 0);
    const hand::JointId id = grip_joint_id(j);
    for (const hand::JointWeights& weights : hand.weights) {
      if (weights.joint != id) continue;
      for (const int v : weights.vertex) is_moved_[j][v] = 1;
    }
    // The correction of the thumb's ball goes with the CMC joint.
    if (id != hand::JointId::kThumbCmc) continue;
    for (const int v : hand.thumb_ball.vertex) is_moved_[j][v] = 1;
  }
}

SkinMotion::Column SkinMotion::column(const hand::Posture& posture, const std::vector<Vec3>& posed,
                                      int joint, const std::vector<int>& vertices) const {
  Column result;
  std::vector<int> moved;
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    if (is_moved_[joint][vertices[k]] == 0) continue;
    result.row.push_back(static_cast<int>(k));
    moved.push_back(vertices[k]);
  }
  if (moved.empty()) return result;
  hand::Posture turned = posture;
  turned[grip_dof(joint)] += kAngleStep;
  result.speed = hand::pose_skin_vertices(*hand_, turned, moved);
  for (std::size_t i = 0; i < moved.size(); ++i) {
    result.speed[i] = (result.speed[i] - posed[moved[i]]) / kAngleStep;
  }
  return result;
}

void SkinMotion::add_touches(const contact::ContactResult& contact, const GripState& state,
                             const std::vector<Vec3>& posed, GripVector& force,
                             GripMatrix& stiffness,
                             std::array<bool, kGripJoints>& is_loaded) const {
  const std::vector<contact::SkinTouch>& touches = contact.skin_touch;
  if (touches.empty()) return;
  const Quat hand_from_product = state.product_from_hand.rotation.conjugate();
  constexpr std::size_t kCorners = 4;
  std::vector<int> corners;
  std::array<double, hand::kRegionCount> depth;
  depth.fill(kLeastDepth);
  for (const contact::SkinTouch& touch : touches) {
    const contact::SkinMeeting& at = touch.meeting;
    corners.insert(corners.end(), {at.vertex, at.on[0], at.on[1], at.on[2]});
    double& d = depth[index_of(hand_->region[at.vertex])];
    d = std::max(d, -at.distance);
  }
  std::vector<GripVector> opening(touches.size(), GripVector::Zero());
  for (int j = 0; j < kGripJoints; ++j) {
    const Column one = column(state.posture, posed, j, corners);
    for (std::size_t i = 0; i < one.row.size(); ++i) {
      const std::size_t k = static_cast<std::size_t>(one.row[i]) / kCorners;
      const std::size_t corner = static_cast<std::size_t>(one.row[i]) % kCorners;
      const contact::SkinMeeting& at = touches[k].meeting;
      const double weight = corner == 0 ? 1.0 : -at.weight[corner - 1];
      opening[k][j] += weight * one.speed[i].dot(hand_from_product * at.normal);
    }
    is_loaded[j] = is_loaded[j] || !one.row.empty();
  }
  for (std::size_t k = 0; k < touches.size(); ++k) {
    const double pressed = touches[k].force;
    const double stiff =
        kForcePower * pressed / depth[index_of(hand_->region[touches[k].meeting.vertex])];
    force += pressed * opening[k];
    stiffness += stiff * opening[k] * opening[k].transpose();
  }
}

}  // namespace palmar::grasp
