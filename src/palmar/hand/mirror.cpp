// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/mirror.h"

#include <utility>

namespace palmar::hand {
namespace {

Vec3 mirrored(const Vec3& point) { return {-point.x(), point.y(), point.z()}; }

/// A rotation axis is a pseudo-vector: mirrored, and turned round so that the same angle gives the
/// mirrored motion.
Vec3 mirrored_axis(const Vec3& axis) { return -mirrored(axis); }

Quat mirrored(const Quat& q) { return {q.w(), q.x(), -q.y(), -q.z()}; }

void mirror(geometry::TriangleMesh& mesh) {
  for (Vec3& v : mesh.vertices) v = mirrored(v);
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
}

void mirror(CmcLimit& limit) {
  limit.q = mirrored(limit.q);
  limit.t = mirrored(limit.t);
}

}  // namespace

Hand mirrored(const Hand& hand) {
  Hand image = hand;
  image.side = hand.side == Side::kRight ? Side::kLeft : Side::kRight;
  mirror(image.skin);
  for (Joint& joint : image.skeleton.joints) {
    joint.centre = mirrored(joint.centre);
    for (JointDof& dof : joint.dofs) {
      dof.axis = mirrored_axis(dof.axis);
      dof.centre = mirrored(dof.centre);
    }
  }
  ThumbCmc& cmc = image.skeleton.thumb_cmc;
  for (CmcLimit* limit : {&cmc.flexion, &cmc.extension, &cmc.abduction, &cmc.adduction}) {
    mirror(*limit);
  }
  for (Vec3& tip : image.skeleton.fingertips) tip = mirrored(tip);
  for (JointWeights& weights : image.weights) {
    for (Vec3& bulge : weights.bulge) bulge = mirrored(bulge);
  }
  for (Vec3& marker : image.thumb_ball.marker) marker = mirrored(marker);
  for (std::vector<Vec3>& coefficient : image.thumb_ball.coefficient) {
    for (Vec3& d : coefficient) d = mirrored(d);
  }
  for (Bone& bone : image.bones) mirror(bone.mesh);
  return image;
}

}  // namespace palmar::hand
