// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/skin/thumb_cmc.h"

#include <gtest/gtest.h>

#include "palmar/core/enum_index.h"

namespace palmar::hand {
namespace {

Skeleton skeleton_with_thumb() {
  Skeleton skeleton;
  Joint& cmc = skeleton.joints[index_of(JointId::kThumbCmc)];
  cmc = make_cmc_joint({28, 36, 19}, {45, 59, 34});
  skeleton.thumb_cmc = make_cmc_limits(cmc);
  return skeleton;
}

TEST(ThumbCmc, OneAxisAloneFollowsEquations25And26) {
  const Skeleton skeleton = skeleton_with_thumb();
  const Vec3 c = skeleton.joint(JointId::kThumbCmc).centre;
  const Vec3 point(50, 70, 40);
  const struct {
    CmcLimit limit;
    double fe, aa;
  } cases[] = {{skeleton.thumb_cmc.flexion, 1, 0},
               {skeleton.thumb_cmc.extension, -1, 0},
               {skeleton.thumb_cmc.abduction, 0, 1},
               {skeleton.thumb_cmc.adduction, 0, -1}};
  for (const auto& one : cases) {
    for (const double s : {0.0, 0.3, 0.7, 1.0}) {
      const geometry::Rigid3 displaced = cmc_displacement(skeleton, {s * one.fe, s * one.aa});
      // q(s) = slerp(1, q, s), t(s) = s t, about the joint's centre.
      const Vec3 expected =
          c + Quat::Identity().slerp(s, one.limit.q) * (point - c) + s * one.limit.t;
      EXPECT_NEAR((displaced * point - expected).norm(), 0, 1e-9) << "s = " << s;  // mm
    }
  }
}

TEST(ThumbCmc, LimitIsARotationAboutThePublishedAxis) {
  const Skeleton skeleton = skeleton_with_thumb();
  const JointDof& abduction = skeleton.dof(Dof::kThumbCmcAbduction);
  Posture posture = reference_posture(skeleton_with_thumb());
  posture[Dof::kThumbCmcAbduction] = abduction.upper;
  const geometry::Rigid3 displaced = cmc_displacement(skeleton, cmc_share(skeleton, posture));
  const geometry::Rigid3 expected = geometry::Rigid3::about_axis(
      abduction.axis, abduction.centre, abduction.upper - abduction.reference);
  EXPECT_NEAR((displaced * Vec3(45, 59, 34) - expected * Vec3(45, 59, 34)).norm(), 0, 1e-9);
}

TEST(ThumbCmc, FlexionGoesAcrossThePalmAndAbductionOutOfIt) {
  const Skeleton skeleton = skeleton_with_thumb();
  const Vec3 mp(45, 59, 34);
  EXPECT_LT((cmc_displacement(skeleton, {0.5, 0}) * mp).x(), mp.x());  // ulnar
  EXPECT_GT((cmc_displacement(skeleton, {-0.5, 0}) * mp).x(), mp.x());
  EXPECT_GT((cmc_displacement(skeleton, {0, 0.5}) * mp).z(), mp.z());  // palmar
  EXPECT_LT((cmc_displacement(skeleton, {0, -0.5}) * mp).z(), mp.z());
}

TEST(ThumbCmc, BaseOfTheMetacarpalStaysOnTheTrapezium) {
  const Skeleton skeleton = skeleton_with_thumb();
  const Vec3 c = skeleton.joint(JointId::kThumbCmc).centre;
  for (const double fe : {-1.0, -0.5, 0.5, 1.0}) {
    for (const double aa : {-1.0, -0.5, 0.5, 1.0}) {
      // The axes pass the centre at 0 and 6.7 mm and turn by up to 36 degrees: at most
      // 2 * 6.7 mm * sin 18 degrees = 4.1 mm.
      EXPECT_LT((cmc_displacement(skeleton, {fe, aa}) * c - c).norm(), 4.2) << fe << " " << aa;
    }
  }
}

TEST(ThumbCmc, ShareIsOneAtTheLimitsAndZeroAtTheReference) {
  const Skeleton skeleton = skeleton_with_thumb();
  const JointDof& flexion = skeleton.dof(Dof::kThumbCmcFlexion);
  Posture posture;
  posture[Dof::kThumbCmcFlexion] = flexion.lower;
  posture[Dof::kThumbCmcAbduction] = skeleton.dof(Dof::kThumbCmcAbduction).reference;
  const CmcShare share = cmc_share(skeleton, posture);
  EXPECT_DOUBLE_EQ(share.s_fe, -1);
  EXPECT_EQ(share.s_aa, 0);
}

}  // namespace
}  // namespace palmar::hand
