// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/skin/skinning.h"

#include <array>
#include <cmath>
#include <cstddef>

#include "palmar/core/enum_index.h"
#include "palmar/hand/skin/thumb_ball.h"

namespace palmar::hand {
namespace {

/// Rotation of a point by angle [cos, sin] about a unit axis through a centre (Rodrigues).
Vec3 turned(const Vec3& point, const Vec3& axis, const Vec3& centre, double angle) {
  const Vec3 arm = point - centre;
  const double c = std::cos(angle), s = std::sin(angle);
  return centre + c * arm + s * axis.cross(arm) + (1.0 - c) * axis.dot(arm) * axis;
}

/// What one joint does to a vertex of full or partial weight.
class JointMotion {
 public:
  JointMotion(const Skeleton& skeleton, JointId id, const Posture& posture)
      : skeleton_(&skeleton), joint_(&skeleton.joint(id)) {
    if (id == JointId::kThumbCmc) {
      share_ = cmc_share(skeleton, posture);
      is_at_rest_ = share_.s_fe == 0 && share_.s_aa == 0;
    } else {
      for (std::size_t k = 0; k < joint_->dofs.size(); ++k) {
        const JointDof& dof = joint_->dofs[k];
        turn_[k] = posture[dof.dof] - dof.reference;
        is_at_rest_ = is_at_rest_ && turn_[k] == 0;
      }
    }
    const geometry::Rigid3 full = displacement(1.0);
    full_rotation_ = full.rotation.toRotationMatrix();
    full_translation_ = full.translation;
  }

  bool is_at_rest() const { return is_at_rest_; }

  Vec3 apply(const Vec3& point, double weight) const {
    if (weight == 1.0) return full_rotation_ * point + full_translation_;
    if (joint_->id == JointId::kThumbCmc || joint_->id == JointId::kWrist) {
      return displacement(weight) * point;
    }
    Vec3 moved = point;
    for (std::size_t k = 0; k < joint_->dofs.size(); ++k) {
      if (turn_[k] == 0) continue;
      const JointDof& dof = joint_->dofs[k];
      moved = turned(moved, dof.axis, dof.centre, weight * turn_[k]);
    }
    return moved;
  }

 private:
  geometry::Rigid3 displacement(double weight) const {
    if (joint_->id == JointId::kThumbCmc) {
      return cmc_displacement(*skeleton_, {weight * share_.s_fe, weight * share_.s_aa});
    }
    geometry::Rigid3 moved;
    for (std::size_t k = 0; k < joint_->dofs.size(); ++k) {
      const JointDof& dof = joint_->dofs[k];
      moved = geometry::Rigid3::about_axis(dof.axis, dof.centre, weight * turn_[k]) * moved;
    }
    // The hand frame is fixed to the palm: what turns at the wrist is the forearm, the other way.
    return joint_->id == JointId::kWrist ? moved.inverse() : moved;
  }

  const Skeleton* skeleton_;
  const Joint* joint_;
  CmcShare share_;
  std::array<double, 3> turn_{};
  bool is_at_rest_ = true;
  Eigen::Matrix3d full_rotation_;
  Vec3 full_translation_;
};

/// Brings out the skin over bent joints, in the reference posture.
void bulge_skin(const Hand& hand, const Posture& posture, const std::vector<int>* slot,
                std::vector<Vec3>& skin) {
  for (const JointWeights& weights : hand.weights) {
    if (weights.bulge.empty()) continue;
    const JointDof& flexion = hand.skeleton.joint(weights.joint).dofs.back();
    const double turn = posture[flexion.dof] - flexion.reference;
    if (!(turn > 0)) continue;
    for (std::size_t k = 0; k < weights.vertex.size(); ++k) {
      auto v = static_cast<std::size_t>(weights.vertex[k]);
      if (slot != nullptr) {
        if ((*slot)[v] < 0) continue;
        v = static_cast<std::size_t>((*slot)[v]);
      }
      skin[v] += turn * weights.bulge[k];
    }
  }
}

/// Moves `skin` (values of the vertices in `slot` terms: slot[v] < 0 = not wanted).
void move_skin(const Hand& hand, const Posture& posture, const std::vector<int>* slot,
               std::vector<Vec3>& skin) {
  bulge_skin(hand, posture, slot, skin);
  for (const JointId id : kDistalToProximal) {
    const JointMotion motion(hand.skeleton, id, posture);
    if (motion.is_at_rest()) continue;
    for (const JointWeights& weights : hand.weights) {
      if (weights.joint != id) continue;
      for (std::size_t k = 0; k < weights.vertex.size(); ++k) {
        auto v = static_cast<std::size_t>(weights.vertex[k]);
        if (slot != nullptr) {
          if ((*slot)[v] < 0) continue;
          v = static_cast<std::size_t>((*slot)[v]);
        }
        skin[v] = motion.apply(skin[v], weights.w1[k] * weights.w2[k]);
      }
    }
  }
}

}  // namespace

std::vector<Vec3> pose_skin(const Hand& hand, const Posture& posture) {
  std::vector<Vec3> skin = hand.skin.vertices;
  move_skin(hand, posture, nullptr, skin);
  const CmcShare share = cmc_share(hand.skeleton, posture);
  for (std::size_t k = 0; k < hand.thumb_ball.vertex.size(); ++k) {
    const int v = hand.thumb_ball.vertex[k];
    skin[v] += thumb_ball_offset(hand.thumb_ball, hand.skin.vertices[v], share);
  }
  return skin;
}

std::vector<Vec3> pose_skin_vertices(const Hand& hand, const Posture& posture,
                                     const std::vector<int>& vertices) {
  // The same vertex may be asked for twice: slots are of first occurrences, the rest is copied.
  std::vector<int> slot(hand.skin.vertices.size(), -1);
  std::vector<Vec3> skin;
  skin.reserve(vertices.size());
  for (const int vertex : vertices) {
    if (slot.at(vertex) >= 0) continue;
    slot[vertex] = static_cast<int>(skin.size());
    skin.push_back(hand.skin.vertices[vertex]);
  }
  move_skin(hand, posture, &slot, skin);
  const CmcShare share = cmc_share(hand.skeleton, posture);
  for (const int vertex : hand.thumb_ball.vertex) {
    if (slot[vertex] < 0) continue;
    skin[slot[vertex]] += thumb_ball_offset(hand.thumb_ball, hand.skin.vertices[vertex], share);
  }
  if (skin.size() == vertices.size()) return skin;
  std::vector<Vec3> posed;
  posed.reserve(vertices.size());
  for (const int vertex : vertices) {
    posed.push_back(skin[slot[vertex]]);
  }
  return posed;
}

std::vector<geometry::TriangleMesh> pose_bones(const Hand& hand, const Posture& posture) {
  const PosedSkeleton posed = pose_skeleton(hand.skeleton, posture);
  std::vector<geometry::TriangleMesh> bones;
  bones.reserve(hand.bones.size());
  for (const Bone& bone : hand.bones) {
    geometry::TriangleMesh mesh = bone.mesh;
    geometry::Rigid3 displacement = posed.forearm;
    if (bone.is_thumb_metacarpal) {
      displacement = posed.thumb_metacarpal;
    } else if (bone.segment) {
      displacement = posed.segment[index_of(*bone.segment)];
    }
    for (Vec3& v : mesh.vertices) v = displacement * v;
    bones.push_back(std::move(mesh));
  }
  return bones;
}

}  // namespace palmar::hand
