// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/posture_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "palmar/core/error.h"
#include "palmar/hand/landmarks.h"
#include "palmar/hand/marker_set.h"
#include "palmar/hand/named_postures.h"
#include "palmar/hand/scaled_hand.h"
#include "palmar/hand/skinning.h"
#include "template_fixture.h"

// Markers of synthetic subjects whose bones are moved by kinematics written here, apart from the
// program's, with measuring noise.

namespace palmar {
namespace {

using ::testing::HasSubstr;

constexpr double kDegree = std::numbers::pi / 180.0;
using Measured = std::vector<std::optional<Vec3>>;

class PostureFitTest : public TemplateTest {};

/// Rodrigues' formula, component by component.
Vec3 turned(const Vec3& p, const Vec3& axis, const Vec3& centre, double angle) {
  const double x = p[0] - centre[0], y = p[1] - centre[1], z = p[2] - centre[2];
  const double u = axis[0], v = axis[1], w = axis[2];
  const double c = std::cos(angle), s = std::sin(angle), k = (u * x + v * y + w * z) * (1 - c);
  return {centre[0] + u * k + x * c + (v * z - w * y) * s,
          centre[1] + v * k + y * c + (w * x - u * z) * s,
          centre[2] + w * k + z * c + (u * y - v * x) * s};
}

/// A marker on a rigid part, moved joint by joint from the tip inwards. The thumb's CMC joint isn't
/// covered: it stays at its reference.
Vec3 carried(const Skeleton& skeleton, Vec3 p, std::vector<JointId> from_distal,
             const Posture& posture) {
  for (const JointId id : from_distal) {
    for (const JointDof& dof : skeleton.joint(id).dofs) {
      p = turned(p, dof.axis, dof.centre, posture[dof.dof] - dof.reference);
    }
  }
  return p;
}

struct Carrier {
  const char* part;
  std::vector<JointId> from_distal;
};
const std::vector<Carrier>& carriers() {
  using J = JointId;
  static const std::vector<Carrier> all = {
      {"palm", {}},
      {"thumb_metacarpal", {}},
      {"thumb_proximal", {J::kThumbMp}},
      {"thumb_distal", {J::kThumbIp, J::kThumbMp}},
      {"index_proximal", {J::kIndexMcp}},
      {"index_middle", {J::kIndexPip, J::kIndexMcp}},
      {"index_distal", {J::kIndexDip, J::kIndexPip, J::kIndexMcp}},
      {"middle_proximal", {J::kMiddleMcp}},
      {"middle_middle", {J::kMiddlePip, J::kMiddleMcp}},
      {"middle_distal", {J::kMiddleDip, J::kMiddlePip, J::kMiddleMcp}},
      {"ring_proximal", {J::kRingMcp}},
      {"ring_middle", {J::kRingPip, J::kRingMcp}},
      {"ring_distal", {J::kRingDip, J::kRingPip, J::kRingMcp}},
      {"little_proximal", {J::kLittleMcp}},
      {"little_middle", {J::kLittlePip, J::kLittleMcp}},
      {"little_distal", {J::kLittleDip, J::kLittlePip, J::kLittleMcp}}};
  return all;
}

/// Three markers on every part, as on rigid plates, about the part's far joint.
struct Plates {
  std::vector<HandPoint> point;
  std::vector<const Carrier*> carrier;
};
Plates plates(const Hand& hand) {
  Plates result;
  for (const Carrier& carrier : carriers()) {
    Vec3 middle = Vec3(0, 45, -10);
    if (!carrier.from_distal.empty()) {
      middle = hand.skeleton.joint(carrier.from_distal.front()).centre + Vec3(0, 12, -9);
    } else if (std::string(carrier.part) == "thumb_metacarpal") {
      middle = hand.skeleton.joint(JointId::kThumbCmc).centre + Vec3(15, 12, 0);
    }
    for (const Vec3& offset : {Vec3(6, 0, 0), Vec3(-6, 0, 0), Vec3(0, 8, 2)}) {
      result.point.push_back(part_point(carrier.part, middle + offset));
      result.carrier.push_back(&carrier);
    }
  }
  return result;
}

/// Angles well inside every range, wrist and thumb CMC at their reference.
Posture drawn_posture(const Skeleton& skeleton, std::mt19937& random) {
  std::uniform_real_distribution<double> share(0.15, 0.85);
  Posture posture = reference_posture(skeleton);
  for (int d = static_cast<int>(Dof::kThumbMpFlexion); d < kDofCount; ++d) {
    const JointDof& dof = skeleton.dof(static_cast<Dof>(d));
    posture[dof.dof] = dof.lower + share(random) * (dof.upper - dof.lower);
  }
  return posture;
}

Measured recorded(const Hand& hand, const Plates& all, const Posture& posture, const Rigid3& place,
                  double noise, std::mt19937& random) {
  std::normal_distribution<double> error(0.0, 1.0);
  Measured measured;
  for (std::size_t i = 0; i < all.point.size(); ++i) {
    Vec3 p = place *
             carried(hand.skeleton, all.point[i].reference, all.carrier[i]->from_distal, posture);
    for (int k = 0; k < 3; ++k) p[k] += noise * error(random);
    measured.emplace_back(p);
  }
  return measured;
}

const Rigid3 kPlace{Quat(Eigen::AngleAxisd(2.5, Vec3(0.3, -0.8, 0.52).normalized())),
                    Vec3(812, -340, 1200)};

TEST_F(PostureFitTest, MarkersWithoutNoiseGiveTheAnglesBack) {
  const Plates all = plates(hand());
  const PostureFitter fitter(hand(), all.point);
  std::mt19937 random(1);
  for (int trial = 0; trial < 5; ++trial) {
    const Posture truth = drawn_posture(hand().skeleton, random);
    const PostureFit fit = fitter.fit(recorded(hand(), all, truth, kPlace, 0.0, random));
    ASSERT_EQ(fit.status, PostureFitStatus::kFitted) << fit.message;
    EXPECT_LT(fit.rms, 0.01);  // mm; the prior of 10 rad pulls by less
    for (int d = static_cast<int>(Dof::kThumbMpFlexion); d < kDofCount; ++d) {
      const auto dof = static_cast<Dof>(d);
      EXPECT_NEAR(fit.posture[dof] / kDegree, truth[dof] / kDegree, 0.1) << name_of(dof);
    }
    EXPECT_TRUE(fit.outliers.empty());
    EXPECT_LT((fit.measured_from_hand.translation - kPlace.translation).norm(), 0.1);
    EXPECT_LT(fit.measured_from_hand.rotation.angularDistance(kPlace.rotation), 0.1 * kDegree);
    // No marker is on the forearm: the wrist is not observed and stays.
    EXPECT_THAT(fit.not_observed, testing::ElementsAre(Dof::kWristFlexion, Dof::kWristDeviation,
                                                       Dof::kWristPronation));
    EXPECT_EQ(fit.posture[Dof::kWristFlexion], hand().skeleton.dof(Dof::kWristFlexion).reference);
  }
}

}  // namespace
}  // namespace palmar
