// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/posture/posture_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "palmar/core/error.h"
#include "palmar/hand/instance/scaled_hand.h"
#include "palmar/hand/mirror.h"
#include "palmar/hand/posture/marker_set.h"
#include "palmar/hand/posture/named_postures.h"
#include "palmar/hand/skin/landmarks.h"
#include "palmar/hand/skin/skinning.h"
#include "template_fixture.h"

// Markers of synthetic subjects whose bones are moved by kinematics written here, apart from the
// program's, with measuring noise.

namespace palmar::tests {
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
Vec3 carried(const hand::Skeleton& skeleton, Vec3 p, std::vector<hand::JointId> from_distal,
             const hand::Posture& posture) {
  for (const hand::JointId id : from_distal) {
    for (const hand::JointDof& dof : skeleton.joint(id).dofs) {
      p = turned(p, dof.axis, dof.centre, posture[dof.dof] - dof.reference);
    }
  }
  return p;
}

struct Carrier {
  const char* part;
  std::vector<hand::JointId> from_distal;
};
const std::vector<Carrier>& carriers() {
  using J = hand::JointId;
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
  std::vector<hand::HandPoint> point;
  std::vector<const Carrier*> carrier;
};
Plates plates(const hand::Hand& hand) {
  Plates result;
  for (const Carrier& carrier : carriers()) {
    Vec3 middle = Vec3(0, 45, -10);
    if (!carrier.from_distal.empty()) {
      middle = hand.skeleton.joint(carrier.from_distal.front()).centre + Vec3(0, 12, -9);
    } else if (std::string(carrier.part) == "thumb_metacarpal") {
      middle = hand.skeleton.joint(hand::JointId::kThumbCmc).centre + Vec3(15, 12, 0);
    }
    for (const Vec3& offset : {Vec3(6, 0, 0), Vec3(-6, 0, 0), Vec3(0, 8, 2)}) {
      result.point.push_back(hand::part_point(carrier.part, middle + offset));
      result.carrier.push_back(&carrier);
    }
  }
  return result;
}

/// Angles well inside every range, wrist and thumb CMC at their reference.
hand::Posture drawn_posture(const hand::Skeleton& skeleton, std::mt19937& random) {
  std::uniform_real_distribution<double> share(0.15, 0.85);
  hand::Posture posture = hand::reference_posture(skeleton);
  for (int d = static_cast<int>(hand::Dof::kThumbMpFlexion); d < hand::kDofCount; ++d) {
    const hand::JointDof& dof = skeleton.dof(static_cast<hand::Dof>(d));
    posture[dof.dof] = dof.lower + share(random) * (dof.upper - dof.lower);
  }
  return posture;
}

Measured recorded(const hand::Hand& hand, const Plates& all, const hand::Posture& posture,
                  const geometry::Rigid3& place, double noise, std::mt19937& random) {
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

const geometry::Rigid3 kPlace{Quat(Eigen::AngleAxisd(2.5, Vec3(0.3, -0.8, 0.52).normalized())),
                              Vec3(812, -340, 1200)};

TEST_F(PostureFitTest, MarkersWithoutNoiseGiveTheAnglesBack) {
  const Plates all = plates(hand());
  const hand::PostureFitter fitter(hand(), all.point);
  std::mt19937 random(1);
  for (int trial = 0; trial < 5; ++trial) {
    const hand::Posture truth = drawn_posture(hand().skeleton, random);
    const hand::PostureFit fit = fitter.fit(recorded(hand(), all, truth, kPlace, 0.0, random));
    ASSERT_EQ(fit.status, hand::PostureFitStatus::kFitted) << fit.message;
    EXPECT_LT(fit.rms, 0.01);  // mm; the prior of 10 rad pulls by less
    for (int d = static_cast<int>(hand::Dof::kThumbMpFlexion); d < hand::kDofCount; ++d) {
      const auto dof = static_cast<hand::Dof>(d);
      EXPECT_NEAR(fit.posture[dof] / kDegree, truth[dof] / kDegree, 0.1) << name_of(dof);
    }
    EXPECT_TRUE(fit.outliers.empty());
    EXPECT_LT((fit.measured_from_hand.translation - kPlace.translation).norm(), 0.1);
    EXPECT_LT(fit.measured_from_hand.rotation.angularDistance(kPlace.rotation), 0.1 * kDegree);
    // No marker is on the forearm: the wrist is not observed and stays.
    EXPECT_THAT(fit.not_observed,
                testing::ElementsAre(hand::Dof::kWristFlexion, hand::Dof::kWristDeviation,
                                     hand::Dof::kWristPronation));
    EXPECT_EQ(fit.posture[hand::Dof::kWristFlexion],
              hand().skeleton.dof(hand::Dof::kWristFlexion).reference);
  }
}

/// Recorded by the built-in set: skin markers over the joints, posed as skin.
Measured dorsal_recording(const hand::Hand& of, const hand::Posture& posture,
                          const geometry::Rigid3& place, double noise, unsigned seed) {
  const hand::MarkerSet set = hand::dorsal_marker_set(of);
  std::mt19937 random(seed);
  std::normal_distribution<double> error(0.0, 1.0);
  Measured measured;
  for (const Vec3& p : hand::PosablePoints(of, set.point).pose(posture)) {
    const double z = error(random), y = error(random), x = error(random);
    measured.emplace_back(place * p + noise * Vec3(x, y, z));
  }
  return measured;
}

std::size_t index_of(const hand::MarkerSet& set, const std::string& label) {
  return static_cast<std::size_t>(std::find(set.label.begin(), set.label.end(), label) -
                                  set.label.begin());
}

double worst_degrees(const hand::Posture& a, const hand::Posture& b) {
  double worst = 0.0;
  for (int d = 0; d < hand::kDofCount; ++d) {
    worst = std::max(
        worst, std::abs(a[static_cast<hand::Dof>(d)] - b[static_cast<hand::Dof>(d)]) / kDegree);
  }
  return worst;
}

TEST_F(PostureFitTest, NoiseComesBackAsResidualAndAsTheAnglesSpread) {
  // 48 markers with 1 mm of noise per axis: 144 numbers minus 26 unknowns leave a root mean square
  // of sqrt(3 (1 - 26/144)) mm per marker. Angles err as the covariance says.
  constexpr double kNoise = 1.0;
  const Plates all = plates(hand());
  const hand::PostureFitter fitter(hand(), all.point, {.point_sd = kNoise});
  std::mt19937 random(7);
  double squares = 0.0, normalised = 0.0;
  int trials = 0, angles = 0;
  for (; trials < 12; ++trials) {
    const hand::Posture truth = drawn_posture(hand().skeleton, random);
    const hand::PostureFit fit = fitter.fit(recorded(hand(), all, truth, kPlace, kNoise, random));
    ASSERT_EQ(fit.status, hand::PostureFitStatus::kFitted) << fit.message;
    EXPECT_TRUE(fit.outliers.empty());
    squares += fit.rms * fit.rms;
    for (int d = static_cast<int>(hand::Dof::kThumbMpFlexion); d < hand::kDofCount; ++d) {
      const auto k = static_cast<std::size_t>(d);
      const double error = fit.posture.angle[k] - truth.angle[k];
      EXPECT_LT(std::abs(error) / kDegree, 25.0) << name_of(static_cast<hand::Dof>(d));
      normalised += std::pow(error / fit.sd[k], 2);
      ++angles;
    }
  }
  const double expected = std::sqrt(3.0 * (1.0 - 26.0 / 144.0)) * kNoise;
  // 12 x 118 degrees of freedom: 2 % of standard error.
  EXPECT_NEAR(std::sqrt(squares / trials), expected, 0.08 * expected);
  // 216 squares of unit variance: standard error 10 %; ranges of motion cut some errors off.
  EXPECT_NEAR(normalised / angles, 1.0, 0.3);
}

TEST_F(PostureFitTest, TheBuiltInSetReportsEveryAngle) {
  hand::Posture truth = *hand::named_posture(hand().skeleton, "cylinder_grip");
  truth[hand::Dof::kWristFlexion] = -25 * kDegree;
  truth[hand::Dof::kWristDeviation] = 10 * kDegree;
  truth[hand::Dof::kWristPronation] = 30 * kDegree;
  const hand::PostureFitter fitter(hand(), hand::dorsal_marker_set(hand()).point);
  const hand::PostureFit fit = fitter.fit(dorsal_recording(hand(), truth, kPlace, 0.0, 1));
  ASSERT_EQ(fit.status, hand::PostureFitStatus::kFitted) << fit.message;
  EXPECT_LT(fit.rms, 0.05);
  EXPECT_LT(worst_degrees(fit.posture, truth), 1.0);
  EXPECT_TRUE(fit.not_observed.empty());
}

TEST_F(PostureFitTest, EveryNamedPostureIsFoundFromNoisyMarkers) {
  const hand::PostureFitter fitter(hand(), hand::dorsal_marker_set(hand()).point);
  for (const std::string& name : hand::posture_names()) {
    const hand::Posture truth = *hand::named_posture(hand().skeleton, name);
    const hand::PostureFit fit = fitter.fit(dorsal_recording(hand(), truth, kPlace, 0.5, 3));
    ASSERT_EQ(fit.status, hand::PostureFitStatus::kFitted) << name << ": " << fit.message;
    for (int d = 0; d < hand::kDofCount; ++d) {
      const auto k = static_cast<std::size_t>(d);
      // sd is for 2 mm, the noise is 0.5 mm: four standard deviations, and a degree for the prior.
      EXPECT_LT(std::abs(fit.posture.angle[k] - truth.angle[k]),
                4.0 * fit.sd[k] * 0.25 + 1.5 * kDegree)
          << name << " " << name_of(static_cast<hand::Dof>(d));
    }
  }
}

TEST_F(PostureFitTest, SwappedMarkersAreNamedAndLeftOut) {
  const hand::MarkerSet set = hand::dorsal_marker_set(hand());
  const hand::PostureFitter fitter(hand(), set.point);
  const hand::Posture truth = *hand::named_posture(hand().skeleton, "relaxed");
  Measured measured = dorsal_recording(hand(), truth, kPlace, 0.3, 5);
  const std::size_t a = index_of(set, "index_pip_dorsal"), b = index_of(set, "middle_dip_dorsal");
  std::swap(measured[a], measured[b]);
  const hand::PostureFit fit = fitter.fit(measured);
  ASSERT_EQ(fit.status, hand::PostureFitStatus::kFitted) << fit.message;
  EXPECT_THAT(fit.outliers,
              testing::UnorderedElementsAre(static_cast<int>(a), static_cast<int>(b)));
  ASSERT_EQ(fit.swapped.size(), 1U);
  EXPECT_EQ(fit.swapped.front(),
            std::make_pair(static_cast<int>(std::min(a, b)), static_cast<int>(std::max(a, b))));
  EXPECT_LT(fit.rms, 1.5);
  for (int d = 0; d < hand::kDofCount; ++d) {
    const auto k = static_cast<std::size_t>(d);
    // sd is for 2 mm; beside a lost marker it is larger.
    EXPECT_LT(std::abs(fit.posture.angle[k] - truth.angle[k]), 3.0 * fit.sd[k])
        << name_of(static_cast<hand::Dof>(d));
  }
  EXPECT_NEAR(fit.posture[hand::Dof::kRingPipFlexion], truth[hand::Dof::kRingPipFlexion],
              3 * kDegree);
}

TEST_F(PostureFitTest, AMarkerFarOffIsLeftOut) {
  const hand::MarkerSet set = hand::dorsal_marker_set(hand());
  const hand::PostureFitter fitter(hand(), set.point);
  const hand::Posture truth = *hand::named_posture(hand().skeleton, "cylinder_grip");
  Measured measured = dorsal_recording(hand(), truth, kPlace, 0.3, 6);
  const std::size_t far = index_of(set, "ring_nail");
  *measured[far] += Vec3(400, -30, 10);
  const hand::PostureFit fit = fitter.fit(measured);
  ASSERT_EQ(fit.status, hand::PostureFitStatus::kFitted) << fit.message;
  EXPECT_THAT(fit.outliers, testing::ElementsAre(static_cast<int>(far)));
  EXPECT_NEAR(*fit.residual[far], 401, 20);
  EXPECT_LT(fit.rms, 1.0);
}

TEST_F(PostureFitTest, WhatMissingMarkersLeaveOpenIsNamed) {
  const hand::MarkerSet set = hand::dorsal_marker_set(hand());
  const hand::PostureFitter fitter(hand(), set.point);
  const hand::Posture truth = *hand::named_posture(hand().skeleton, "relaxed");
  Measured measured = dorsal_recording(hand(), truth, kPlace, 0.0, 1);
  for (const char* label :
       {"middle_dip_dorsal", "middle_nail", "radial_styloid", "ulnar_styloid"}) {
    measured[index_of(set, label)].reset();
  }
  const hand::PostureFit fit = fitter.fit(measured);
  ASSERT_EQ(fit.status, hand::PostureFitStatus::kFitted) << fit.message;
  EXPECT_THAT(fit.not_observed,
              testing::IsSupersetOf({hand::Dof::kMiddleDipFlexion, hand::Dof::kWristFlexion,
                                     hand::Dof::kWristDeviation}));
  EXPECT_EQ(fit.posture[hand::Dof::kMiddleDipFlexion],
            hand().skeleton.dof(hand::Dof::kMiddleDipFlexion).reference);
  EXPECT_FALSE(fit.residual[index_of(set, "middle_nail")]);
  EXPECT_NEAR(fit.posture[hand::Dof::kIndexPipFlexion] / kDegree,
              truth[hand::Dof::kIndexPipFlexion] / kDegree, 1.0);
}

TEST_F(PostureFitTest, TheOtherHandIsRecognised) {
  const hand::Hand left = hand::mirrored(hand());
  const hand::Posture truth = *hand::named_posture(left.skeleton, "cylinder_grip");
  const Measured measured = dorsal_recording(left, truth, kPlace, 0.5, 1);
  const hand::PostureFit wrong =
      hand::PostureFitter(hand(), hand::dorsal_marker_set(hand()).point).fit(measured);
  EXPECT_EQ(wrong.status, hand::PostureFitStatus::kMirrored) << wrong.message;
  EXPECT_THAT(wrong.message, HasSubstr("hand mirror"));
  const hand::PostureFit right =
      hand::PostureFitter(left, hand::dorsal_marker_set(left).point).fit(measured);
  EXPECT_EQ(right.status, hand::PostureFitStatus::kFitted) << right.message;
  EXPECT_LT(right.rms, 1.2);
}

TEST_F(PostureFitTest, MirroredMarkersOnTheMirroredHandGiveTheSameAngles) {
  const hand::Hand left = hand::mirrored(hand());
  Measured measured =
      dorsal_recording(hand(), *hand::named_posture(hand().skeleton, "tripod"), kPlace, 0.5, 9);
  const hand::PostureFit here =
      hand::PostureFitter(hand(), hand::dorsal_marker_set(hand()).point).fit(measured);
  for (auto& one : measured) one->x() = -one->x();
  const hand::PostureFit there =
      hand::PostureFitter(left, hand::dorsal_marker_set(left).point).fit(measured);
  EXPECT_NEAR(here.rms, there.rms, 1e-3);
  EXPECT_LT(worst_degrees(here.posture, there.posture), 0.05);
}

TEST_F(PostureFitTest, AMovedRecordingGivesTheSameAngles) {
  const Measured measured = dorsal_recording(
      hand(), *hand::named_posture(hand().skeleton, "tripod"), geometry::Rigid3{}, 0.5, 9);
  Measured moved = measured;
  for (auto& one : moved) *one = kPlace * *one;
  const hand::PostureFitter fitter(hand(), hand::dorsal_marker_set(hand()).point);
  const hand::PostureFit a = fitter.fit(measured), b = fitter.fit(moved);
  EXPECT_NEAR(a.rms, b.rms, 1e-4);
  EXPECT_LT(worst_degrees(a.posture, b.posture), 0.02);
}

TEST_F(PostureFitTest, MetresForMillimetresAreRefused) {
  Measured measured = dorsal_recording(hand(), *hand::named_posture(hand().skeleton, "flat"),
                                       geometry::Rigid3{}, 0.0, 1);
  const hand::PostureFitter fitter(hand(), hand::dorsal_marker_set(hand()).point);
  for (auto& one : measured) *one *= 0.001;
  const hand::PostureFit small = fitter.fit(measured);
  EXPECT_EQ(small.status, hand::PostureFitStatus::kWrongUnit);
  EXPECT_THAT(small.message, HasSubstr("unit"));
  for (auto& one : measured) *one *= 1e6;
  EXPECT_EQ(fitter.fit(measured).status, hand::PostureFitStatus::kWrongUnit);
}

TEST_F(PostureFitTest, TooFewOrOneFingerAloneIsSaid) {
  const hand::MarkerSet set = hand::dorsal_marker_set(hand());
  const hand::PostureFitter fitter(hand(), set.point);
  Measured measured(set.label.size());
  EXPECT_EQ(fitter.fit(measured).status, hand::PostureFitStatus::kTooFew);
  const Measured all = dorsal_recording(hand(), *hand::named_posture(hand().skeleton, "flat"),
                                        geometry::Rigid3{}, 0.0, 1);
  for (const char* label :
       {"index_mcp_dorsal", "index_pip_dorsal", "index_dip_dorsal", "index_nail"}) {
    measured[index_of(set, label)] = all[index_of(set, label)];
  }
  const hand::PostureFit one = fitter.fit(measured);
  EXPECT_EQ(one.status, hand::PostureFitStatus::kTooFew);
  EXPECT_THAT(one.message, HasSubstr("palm"));
}

TEST_F(PostureFitTest, AnotherSizeIsFoundIfAskedFor) {
  const hand::Hand large = hand::scaled(hand(), 1.12);
  const hand::Posture truth = *hand::named_posture(large.skeleton, "cylinder_grip");
  const Measured measured = dorsal_recording(large, truth, kPlace, 0.0, 1);
  const std::vector<hand::HandPoint> points = hand::dorsal_marker_set(hand()).point;
  const hand::PostureFit fixed = hand::PostureFitter(hand(), points).fit(measured);
  const hand::PostureFit free =
      hand::PostureFitter(hand(), points, {.fits_scale = true}).fit(measured);
  EXPECT_NEAR(free.scale, 1.12, 0.003);
  EXPECT_LT(free.rms, 0.1);
  EXPECT_LT(worst_degrees(free.posture, truth), 1.0);
  EXPECT_GT(fixed.rms, 10 * free.rms);
  EXPECT_EQ(fixed.scale, 1.0);
}

TEST_F(PostureFitTest, ASequenceIsFollowed) {
  const hand::PostureFitter fitter(hand(), hand::dorsal_marker_set(hand()).point);
  const hand::Posture from = *hand::named_posture(hand().skeleton, "flat");
  const hand::Posture to = *hand::named_posture(hand().skeleton, "fist");
  std::optional<hand::PostureFit> before;
  for (int f = 0; f <= 20; ++f) {
    hand::Posture truth;
    for (std::size_t d = 0; d < hand::kDofCount; ++d) {
      truth.angle[d] = from.angle[d] + f / 20.0 * (to.angle[d] - from.angle[d]);
    }
    const geometry::Rigid3 place{kPlace.rotation, kPlace.translation + Vec3(5.0 * f, 0, 0)};
    const hand::PostureFit fit =
        fitter.fit(dorsal_recording(hand(), truth, place, 0.3, static_cast<unsigned>(f)),
                   before ? &*before : nullptr);
    ASSERT_EQ(fit.status, hand::PostureFitStatus::kFitted) << f << ": " << fit.message;
    EXPECT_LT(fit.rms, 0.8) << f;
    EXPECT_LT(worst_degrees(fit.posture, truth), 8.0) << f;
    before = fit;
  }
}

TEST_F(PostureFitTest, BadArgumentsAreRefusedByName) {
  const std::vector<hand::HandPoint> points = hand::dorsal_marker_set(hand()).point;
  EXPECT_THROW(hand::PostureFitter(hand(), {}), UsageError);
  EXPECT_THROW(hand::PostureFitter(hand(), points, {.point_sd = 0.0}), UsageError);
  const hand::PostureFitter fitter(hand(), points);
  EXPECT_THROW(fitter.fit(Measured(3)), UsageError);
  Measured broken(points.size());
  broken[4] = Vec3(0, std::nan(""), 0);
  EXPECT_THROW(fitter.fit(broken), UsageError);
}

}  // namespace
}  // namespace palmar::tests
