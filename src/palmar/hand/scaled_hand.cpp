// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/scaled_hand.h"

#include <string>

#include "palmar/core/error.h"

namespace palmar {
namespace {

void scale(std::vector<Vec3>& points, double factor) {
  for (Vec3& point : points) point *= factor;
}

void scale(SegmentDimensions& size, double factor) {
  size.length *= factor;
  size.width *= factor;
  size.thickness *= factor;
}

void scale(Skeleton& skeleton, double factor) {
  for (Joint& joint : skeleton.joints) {
    joint.centre *= factor;
    for (JointDof& dof : joint.dofs) dof.centre *= factor;
  }
  ThumbCmc& cmc = skeleton.thumb_cmc;
  for (CmcLimit* limit : {&cmc.flexion, &cmc.extension, &cmc.abduction, &cmc.adduction}) {
    limit->t *= factor;
  }
  for (Vec3& tip : skeleton.fingertips) tip *= factor;
}

}  // namespace

Hand scaled(const Hand& hand, double factor) {
  if (!(factor >= 0.2 && factor <= 5.0)) {
    throw UsageError("scale of hand \"" + hand.name + "\" is " + std::to_string(factor) +
                     "; 0.2 to 5 is allowed");
  }
  Hand result = hand;
  scale(result.skin.vertices, factor);
  scale(result.skeleton, factor);
  for (JointWeights& weights : result.weights) scale(weights.bulge, factor);
  result.thumb_ball.beta /= factor * factor;
  scale(result.thumb_ball.marker, factor);
  for (std::vector<Vec3>& coefficient : result.thumb_ball.coefficient) scale(coefficient, factor);
  for (Bone& bone : result.bones) scale(bone.mesh.vertices, factor);
  HandDimensions& size = result.dimensions;
  size.hand_length *= factor;
  size.hand_circumference *= factor;
  size.hand_width *= factor;
  size.hand_thickness *= factor;
  for (SegmentDimensions& segment : size.segment) scale(segment, factor);
  result.provenance += "; scaled by " + std::to_string(factor);
  return result;
}

}  // namespace palmar
