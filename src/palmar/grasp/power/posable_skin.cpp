// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/power/posable_skin.h"

#include <cmath>
#include <utility>

#include "palmar/hand/skin/skinning.h"

namespace palmar::grasp {
namespace {

geometry::Rigid3 displacement(const hand::Skeleton& skeleton, hand::JointId id,
                              const hand::Posture& posture, double weight) {
  if (id == hand::JointId::kThumbCmc) {
    hand::CmcShare share = hand::cmc_share(skeleton, posture);
    share.s_fe *= weight;
    share.s_aa *= weight;
    return hand::cmc_displacement(skeleton, share);
  }
  geometry::Rigid3 moved;
  for (const hand::JointDof& dof : skeleton.joint(id).dofs) {
    const double turn = posture[dof.dof] - dof.reference;
    if (turn == 0.0) continue;
    moved = geometry::Rigid3::about_axis(dof.axis, dof.centre, weight * turn) * moved;
  }
  // The hand frame is fixed to the palm: what turns at the wrist is the forearm, the other way.
  return id == hand::JointId::kWrist ? moved.inverse() : moved;
}

bool is_at_rest(const hand::Skeleton& skeleton, hand::JointId id, const hand::Posture& posture) {
  for (const hand::JointDof& dof : skeleton.joint(id).dofs) {
    if (posture[dof.dof] != dof.reference) return false;
  }
  return true;
}

}  // namespace

PosableSkin::PosableSkin(const hand::Hand& hand, std::vector<int> vertices)
    : hand_(&hand), vertices_(std::move(vertices)) {
  std::vector<int> slot(hand.skin.vertices.size(), -1);
  for (std::size_t k = 0; k < vertices_.size(); ++k) {
    const int v = vertices_[k];
    slot[v] = static_cast<int>(k);
    reference_.push_back(hand.skin.vertices[v]);
  }
  for (const int v : hand.thumb_ball.vertex) {
    has_thumb_ball_ = has_thumb_ball_ || slot[v] >= 0;
  }
  for (const hand::JointWeights& weights : hand.weights) {
    if (weights.bulge.empty()) continue;
    JointBulge bulge{weights.joint, {}, {}};
    for (std::size_t k = 0; k < weights.vertex.size(); ++k) {
      const int s = slot[weights.vertex[k]];
      if (s < 0 || weights.bulge[k] == Vec3::Zero()) continue;
      bulge.slot.push_back(s);
      bulge.bulge.push_back(weights.bulge[k]);
    }
    if (!bulge.slot.empty()) bulges_.push_back(std::move(bulge));
  }
  for (const hand::JointId id : hand::kDistalToProximal) {
    JointShare share{id, {}, {}, {}};
    for (const hand::JointWeights& weights : hand.weights) {
      if (weights.joint != id) continue;
      for (std::size_t k = 0; k < weights.vertex.size(); ++k) {
        const int s = slot[weights.vertex[k]];
        if (s < 0) continue;
        const double w = weights.w1[k] * weights.w2[k];
        if (w == 1.0) {
          share.full.push_back(s);
        } else {
          share.part.push_back(s);
          share.weight.push_back(w);
        }
      }
    }
    if (!share.full.empty() || !share.part.empty()) shares_.push_back(std::move(share));
  }
}

void PosableSkin::pose(const hand::Posture& posture, std::vector<Vec3>& posed) const {
  if (has_thumb_ball_) {
    posed = hand::pose_skin_vertices(*hand_, posture, vertices_);
    return;
  }
  posed = reference_;
  const hand::Skeleton& skeleton = hand_->skeleton;
  for (const JointBulge& bulge : bulges_) {
    const hand::JointDof& flexion = skeleton.joint(bulge.joint).dofs.back();
    const double turn = posture[flexion.dof] - flexion.reference;
    if (!(turn > 0.0)) continue;
    for (std::size_t k = 0; k < bulge.slot.size(); ++k) {
      posed[bulge.slot[k]] += turn * bulge.bulge[k];
    }
  }
  for (const JointShare& share : shares_) {
    if (is_at_rest(skeleton, share.joint, posture)) continue;
    const geometry::Rigid3 whole = displacement(skeleton, share.joint, posture, 1.0);
    const Eigen::Matrix3d rotation = whole.rotation.toRotationMatrix();
    for (const int s : share.full) {
      Vec3& p = posed[s];
      p = rotation * p + whole.translation;
    }
    for (std::size_t k = 0; k < share.part.size(); ++k) {
      Vec3& p = posed[share.part[k]];
      p = displacement(skeleton, share.joint, posture, share.weight[k]) * p;
    }
  }
}

}  // namespace palmar::grasp
