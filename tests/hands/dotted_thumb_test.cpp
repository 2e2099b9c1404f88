// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/scan/dotted_thumb.h"

#include "template_fixture.h"

namespace palmar::tests {
namespace {

class DottedThumb : public TemplateTest {
 protected:
  /// What dots on the thumb's back show in a posture; the skin errs by 7 degrees at both joints.
  static capture::ThumbReading read(const hand::Posture& posture, double off) {
    const hand::Skeleton& skeleton = hand().skeleton;
    const hand::PosedSkeleton posed = hand::pose_skeleton(skeleton, posture);
    capture::ThumbDots dots;
    const auto add = [&](hand::JointId from, hand::JointId to, hand::Segment segment,
                         std::vector<Vec3>& x, std::vector<Vec3>& y) {
      const Vec3& a = skeleton.joint(from).centre;
      const Vec3 along = skeleton.joint(to).centre - a;
      const Vec3 aside = along.unitOrthogonal(), up = along.cross(aside).normalized();
      for (const auto& [share, side] : {std::pair{0.3, 0.0}, {0.6, -3.0}, {0.6, 3.0}}) {
        x.push_back(a + share * along + 8.0 * up + side * aside);
        y.push_back(posed.segment[static_cast<std::size_t>(segment)] * x.back());
      }
    };
    add(hand::JointId::kThumbMp, hand::JointId::kThumbIp, hand::Segment::kThumbProximal,
        dots.x_proximal, dots.y_proximal);
    add(hand::JointId::kThumbIp, hand::JointId::kThumbMp, hand::Segment::kThumbDistal,
        dots.x_distal, dots.y_distal);
    hand::Posture by_skin = posture;
    by_skin[hand::Dof::kThumbCmcFlexion] += off;
    by_skin[hand::Dof::kThumbMpFlexion] -= off;
    return capture::read_thumb(dots, skeleton, by_skin);
  }
  static hand::Posture bent() {
    hand::Posture posture = hand::reference_posture(hand().skeleton);
    posture[hand::Dof::kThumbCmcFlexion] += 0.3;
    posture[hand::Dof::kThumbCmcAbduction] -= 0.1;
    posture[hand::Dof::kThumbMpFlexion] += 0.4;
    posture[hand::Dof::kThumbIpFlexion] += 0.6;
    return posture;
  }
};

TEST_F(DottedThumb, ReportsTheMetacarpalByTheDotsBeyondIt) {
  const geometry::Rigid3 truth = hand::pose_skeleton(hand().skeleton, bent()).thumb_metacarpal;
  const Vec3& mp = hand().skeleton.joint(hand::JointId::kThumbMp).centre;
  EXPECT_LT((read(bent(), 0.0).metacarpal * mp - truth * mp).norm(), 1e-3);
  EXPECT_LT(read(bent(), 0.0).residual, 1e-3);
  // 7 degrees move the MP joint by 5 mm; dots bring it back but for what priors hold.
  const capture::ThumbReading reading = read(bent(), 0.12);
  EXPECT_LT((reading.metacarpal * mp - truth * mp).norm(), 1.5);
  EXPECT_LT(reading.metacarpal.rotation.angularDistance(truth.rotation), 0.06);
  EXPECT_EQ(reading.dots, 6);
  // Without dots the skin has its way.
  const capture::ThumbReading by_skin = capture::read_thumb({}, hand().skeleton, bent());
  EXPECT_LT((by_skin.metacarpal * mp - truth * mp).norm(), 1e-6);
}

TEST_F(DottedThumb, LimitPosturesMakeTheSaddleJoint) {
  const hand::Skeleton& skeleton = hand().skeleton;
  const std::array<std::pair<hand::ScanPosture, std::array<double, 2>>, 4> limit{
      {{hand::ScanPosture::kThumbFlexion, {0.4, 0.0}},
       {hand::ScanPosture::kThumbExtension, {-0.4, 0.0}},
       {hand::ScanPosture::kThumbAbduction, {0.0, 0.3}},
       {hand::ScanPosture::kThumbAdduction, {0.0, -0.3}}}};
  std::map<hand::ScanPosture, capture::ThumbReading> readings;
  for (const auto& [name, by] : limit) {
    hand::Posture posture = hand::reference_posture(skeleton);
    posture[hand::Dof::kThumbCmcFlexion] += by[0];
    posture[hand::Dof::kThumbCmcAbduction] += by[1];
    readings[name] = read(posture, 0.0);
  }
  readings[hand::ScanPosture::kFingerFlexion] = read(bent(), 0.0);
  capture::MeasuredJoints joints;
  joints.skeleton = skeleton;
  joints.postures[hand::ScanPosture::kFingerFlexion] = bent();
  capture::take_thumb_readings(hand(), readings, joints);
  const Vec3& mp = skeleton.joint(hand::JointId::kThumbMp).centre;
  for (const auto& [name, reading] : readings) {
    const Vec3 there =
        hand::pose_skeleton(joints.skeleton, joints.postures.at(name)).thumb_metacarpal * mp;
    const double allowed =
        capture::is_thumb_limit(name) ? 0.05 : 1.0;  // mm; the bent one is no limit
    EXPECT_LT((there - reading.metacarpal * mp).norm(), allowed) << name_of(name);
  }
  const hand::JointDof& flexion = joints.skeleton.dof(hand::Dof::kThumbCmcFlexion);
  EXPECT_NEAR(flexion.upper - flexion.lower, 0.8, 0.05);
  EXPECT_TRUE(joints.is_measured[static_cast<std::size_t>(hand::Dof::kThumbCmcFlexion)]);
}

}  // namespace
}  // namespace palmar::tests
