// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "palmar/hand/hand.h"

namespace palmar::hand {

/// Joints from distal to proximal, the order in which they move skin; within a web two fingers' MCP
/// joints act on the same vertex, one after the other in this order.
inline constexpr std::array<JointId, kJointCount> kDistalToProximal = {
    JointId::kIndexDip, JointId::kMiddleDip, JointId::kRingDip,  JointId::kLittleDip,
    JointId::kIndexPip, JointId::kMiddlePip, JointId::kRingPip,  JointId::kLittlePip,
    JointId::kIndexMcp, JointId::kMiddleMcp, JointId::kRingMcp,  JointId::kLittleMcp,
    JointId::kThumbIp,  JointId::kThumbMp,   JointId::kThumbCmc, JointId::kWrist};

/// Skin of a hand in a posture, vertex for vertex, in the hand frame (fixed to the palm), mm.
///
/// First the skin over bent joints comes out by weights.bulge times the flexion beyond the
/// reference (an addition that keeps the volume). Then angles are blended, not matrices: for joint
/// j with axis (u_j, p_j) in the reference posture, v' = Rot(u_j, p_j, w1_ij w2_ij (theta_j -
/// reference_j)) v, joints applied from distal to proximal (Xie 2014, eq. 2-7); the thumb CMC by
/// interpolation of its limit postures (eq. 2-5, 2-6); then the thumb-ball correction (eq. 2-8 to
/// 2-10). Angles are used as they are; clamp first.
std::vector<Vec3> pose_skin(const Hand& hand, const Posture& posture);

/// Only some vertices: posed[k] is where vertices[k] goes. Same result as pose_skin() at those.
std::vector<Vec3> pose_skin_vertices(const Hand& hand, const Posture& posture,
                                     const std::vector<int>& vertices);

/// Bones of a hand in a posture, in the order of hand.bones.
std::vector<geometry::TriangleMesh> pose_bones(const Hand& hand, const Posture& posture);

}  // namespace palmar::hand
