// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/posture/skeleton_in_posture.h"

#include <gtest/gtest.h>

#include "palmar/core/enum_index.h"
#include "palmar/hand/skin/thumb_cmc.h"

namespace palmar::hand {
namespace {

/// Index finger of three joints, the first with two axes that aren't square, and a thumb.
Skeleton skeleton() {
  Skeleton s;
  Joint& cmc = s.joints[index_of(JointId::kThumbCmc)];
  cmc = make_cmc_joint({28, 36, 19}, {45, 59, 34});
  s.thumb_cmc = make_cmc_limits(cmc);
  const auto hinge = [](Dof dof, const Vec3& axis, const Vec3& centre, double reference) {
    return JointDof{dof, axis.normalized(), centre, reference, -0.6, 1.6, ""};
  };
  const auto joint = [&](JointId id, const Vec3& centre) -> Joint& {
    Joint& j = s.joints[index_of(id)];
    j.id = id;
    j.centre = centre;
    return j;
  };
  joint(JointId::kIndexMcp, {25, 90, 0}).dofs = {
      hinge(Dof::kIndexMcpAbduction, {0.1, 0.2, 1}, {25, 91, 0}, 0.05),
      hinge(Dof::kIndexMcpFlexion, {1, 0.1, 0}, {25, 90, 0}, 0.2)};
  joint(JointId::kIndexPip, {27, 130, 3}).dofs = {
      hinge(Dof::kIndexPipFlexion, {1, 0, 0.1}, {27, 130, 3}, 0.3)};
  joint(JointId::kIndexDip, {28, 155, 6}).dofs = {
      hinge(Dof::kIndexDipFlexion, {1, 0, 0}, {28, 155, 6}, 0.1)};
  s.fingertips[1] = {29, 175, 9};
  return s;
}

Posture some_posture(double size) {
  Posture p = reference_posture(skeleton());
  p[Dof::kIndexMcpAbduction] += 0.2 * size;
  p[Dof::kIndexMcpFlexion] += 0.7 * size;
  p[Dof::kIndexPipFlexion] += 0.9 * size;
  p[Dof::kIndexDipFlexion] -= 0.3 * size;
  return p;
}

void expect_same(const geometry::Rigid3& a, const geometry::Rigid3& b) {
  for (const Vec3& p : {Vec3(30, 160, 5), Vec3(0, 0, 0), Vec3(-20, 90, 40)}) {
    EXPECT_LT((a * p - b * p).norm(), 1e-9);
  }
}

TEST(SkeletonInPosture, MovesOnAsBeforeFromThere) {
  const Skeleton before = skeleton();
  const Posture there = some_posture(1.0), further = some_posture(-0.6);
  const Skeleton after = skeleton_in_posture(before, there);
  const PosedSkeleton old_there = pose_skeleton(before, there);
  const PosedSkeleton old_further = pose_skeleton(before, further);
  const PosedSkeleton now = pose_skeleton(after, further);
  for (const Segment s : {Segment::kIndexProximal, Segment::kIndexMiddle, Segment::kIndexDistal}) {
    expect_same(now.segment[index_of(s)],
                old_further.segment[index_of(s)] * old_there.segment[index_of(s)].inverse());
  }
  const std::size_t distal = index_of(Segment::kIndexDistal);
  EXPECT_LT((after.fingertips[1] - old_there.segment[distal] * before.fingertips[1]).norm(), 1e-9);
  EXPECT_EQ(reference_posture(after)[Dof::kIndexPipFlexion], there[Dof::kIndexPipFlexion]);
}

TEST(SkeletonInPosture, ThumbReachesTheSameLimits) {
  const Skeleton before = skeleton();
  Posture there = reference_posture(before);
  const JointDof& flexion = before.dof(Dof::kThumbCmcFlexion);
  there[Dof::kThumbCmcFlexion] = 0.5 * (flexion.reference + flexion.upper);
  const Skeleton after = skeleton_in_posture(before, there);
  Posture limit = there;
  limit[Dof::kThumbCmcFlexion] = flexion.upper;
  expect_same(pose_skeleton(after, limit).thumb_metacarpal,
              pose_skeleton(before, limit).thumb_metacarpal *
                  pose_skeleton(before, there).thumb_metacarpal.inverse());
  expect_same(pose_skeleton(after, there).thumb_metacarpal, {});
}

TEST(SkeletonInPosture, RangesGrowToHoldIt) {
  Posture there = reference_posture(skeleton());
  there[Dof::kIndexPipFlexion] = 1.9;
  EXPECT_EQ(skeleton_in_posture(skeleton(), there).dof(Dof::kIndexPipFlexion).upper, 1.9);
}

}  // namespace
}  // namespace palmar::hand
