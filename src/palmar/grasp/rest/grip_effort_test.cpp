// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/rest/grip_effort.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "palmar/core/enum_index.h"
#include "palmar/geometry/degrees.h"
#include "palmar/hand/tendons/tendon_test_hand.h"

namespace palmar::grasp {
namespace {

constexpr int kMiddleFirst = hand::kDigitDofs * static_cast<int>(hand::Finger::kMiddle);

const hand::Hand& hand() {
  static const hand::Hand made = hand::effort_test::plain_hand();
  return made;
}

hand::Posture bent() {
  hand::Posture posture = hand::reference_posture(hand().skeleton);
  posture[hand::Dof::kMiddleMcpFlexion] = 50 * geometry::kDegree;
  posture[hand::Dof::kMiddlePipFlexion] = 45 * geometry::kDegree;
  posture[hand::Dof::kMiddleDipFlexion] = 30 * geometry::kDegree;
  posture[hand::Dof::kThumbIpFlexion] = 40 * geometry::kDegree;
  return posture;
}

/// Only these angles are loaded.
std::array<bool, kGripJoints> loaded(std::initializer_list<int> joints) {
  std::array<bool, kGripJoints> is{};
  for (const int joint : joints) is[static_cast<std::size_t>(joint)] = true;
  return is;
}

GripVector opening(double scale) {
  GripVector force = GripVector::Zero();
  force[kMiddleFirst] = -900.0 * scale;
  force[kMiddleFirst + 2] = -500.0 * scale;
  force[kMiddleFirst + 3] = -120.0 * scale;
  return force;
}

const Eigen::MatrixXd kOneAngle = Eigen::MatrixXd::Constant(1, 1, 4000.0);  // N mm/rad

/// One finger whose DIP alone is loaded: FDP is the only muscle that flexes it. A spring of the
/// product resists its flexion.
TEST(GripEffort, ActivationOfTheOnlyMuscleIsMomentOverStrengthTimesArm) {
  GripEffort effort(hand(), 1.0, bent());
  const int dip = kMiddleFirst + 3;
  effort.look(bent(), loaded({dip}));
  const hand::DigitMuscles digit = hand::HandMuscles(hand()).in(hand::Finger::kMiddle, bent());
  GripVector force = GripVector::Zero();
  force[dip] = -150.0;  // N mm, opens it
  GripMatrix stiffness = GripMatrix::Zero();
  stiffness(dip, dip) = 4000.0;  // N mm/rad
  GripVector squeeze = GripVector::Zero();
  squeeze[dip] = 30.0;  // N/rad
  // At rest with no more squeeze: the muscle's moment is the load's, the wrist's extensors hold it.
  const GripEffort::Step step = effort.solve({.free = {dip},
                                              .k = kOneAngle,
                                              .force = force,
                                              .stiffness = stiffness,
                                              .squeeze = squeeze,
                                              .missing = 0.0});
  EXPECT_FALSE(step.is_short);
  EXPECT_NEAR(step.way[dip], 0.0, 1e-6);
  EXPECT_NEAR(effort.moments()[dip], 150.0, 0.01);
  const double fdp = effort.activations().activation[8 + 6];  // after the thumb and the index
  const auto& activation = effort.activations().activation;
  double opened = 0.0;  // by what extends it, to relieve other muscles: next to nothing
  for (std::size_t t = 1; t < digit.arm.size(); ++t) {
    opened += activation[14 + static_cast<Eigen::Index>(t)] * digit.strength[t] * digit.arm[t][3];
  }
  EXPECT_NEAR(fdp, (150.0 - opened) / (digit.strength[0] * digit.arm[0][3]), 1e-4);
  // More squeeze: 1.5 N need 0.05 rad, 200 N mm more.
  const GripEffort::Step more = effort.solve({.free = {dip},
                                              .k = kOneAngle,
                                              .force = force,
                                              .stiffness = stiffness,
                                              .squeeze = squeeze,
                                              .missing = 1.5});
  EXPECT_NEAR(more.way[dip], 0.05, 1e-6);
  EXPECT_NEAR(effort.moments()[dip], 350.0, 0.05);
}

TEST(GripEffort, SqueezeIsMissedWhereMusclesAreTooWeak) {
  GripEffort effort(hand(), 0.1, bent());
  const int dip = kMiddleFirst + 3;
  effort.look(bent(), loaded({dip}));
  GripVector squeeze = GripVector::Zero();
  squeeze[dip] = 30.0;
  GripMatrix stiffness = GripMatrix::Zero();
  stiffness(dip, dip) = 4000.0;
  const GripEffort::Step step = effort.solve({.free = {dip},
                                              .k = kOneAngle,
                                              .force = GripVector::Zero(),
                                              .stiffness = stiffness,
                                              .squeeze = squeeze,
                                              .missing = 50.0});
  EXPECT_TRUE(step.is_short);
  const hand::DigitMuscles digit = hand::HandMuscles(hand()).in(hand::Finger::kMiddle, bent());
  EXPECT_LT(30.0 * step.way[dip], 50.0);
  EXPECT_NEAR(effort.moments()[dip], 0.1 * digit.strength[0] * digit.arm[0][3],
              0.01 * effort.moments()[dip]);
}

constexpr int kThumbIp = 3;

/// The thumb's end has given way by `way` to a spring of 2000 N mm/rad, which now pushes with
/// `force`; how far it goes in the next step.
double way_of_thumb(double force, double way) {
  hand::Posture posture = bent();
  posture[hand::Dof::kThumbIpFlexion] += way;
  GripEffort effort(hand(), 0.5, bent());
  effort.look(posture, loaded({kThumbIp, kMiddleFirst + 3}));
  GripVector on = GripVector::Zero();
  on[kThumbIp] = -force;
  GripMatrix stiffness = GripMatrix::Zero();
  stiffness(kThumbIp, kThumbIp) = 2000.0;
  stiffness(kMiddleFirst + 3, kMiddleFirst + 3) = 4000.0;
  return effort
      .solve({.free = {kMiddleFirst + 3},
              .k = kOneAngle,
              .force = on,
              .stiffness = stiffness,
              .squeeze = GripVector::Zero(),
              .missing = 0.0})
      .way[kThumbIp];
}

/// What flexes the thumb's end, at half activation, stretched by `way` [rad] times its arm.
double most_of_thumb(double way) {
  hand::Posture posture = bent();
  posture[hand::Dof::kThumbIpFlexion] += way;
  const hand::DigitMuscles thumb = hand::HandMuscles(hand()).in(hand::Finger::kThumb, posture);
  double most = 0.0;
  for (std::size_t t = 0; t < thumb.arm.size(); ++t) {
    const double arm = thumb.arm[t][kThumbIp];
    const double stretch = -arm * way / thumb.fibre[t];
    const double more = std::clamp(23.4 * stretch, 0.0, 0.3);
    if (arm > 0.0) most += 0.5 * thumb.strength[t] * arm * (1.0 + more);
  }
  return most;
}

TEST(GripEffort, AThumbThatGaveWayComesBackAsFarAsItsMusclesCanBringIt) {
  const double most = most_of_thumb(-0.04);
  ASSERT_GT(most, 200.0);
  EXPECT_NEAR(way_of_thumb(most - 150.0, -0.04), 0.04, 1e-6);  // 80 more than now: can
  EXPECT_NEAR(way_of_thumb(most - 50.0, -0.04), 0.025, 1e-3);  // 50 of the 80
  EXPECT_NEAR(way_of_thumb(most, -0.04), 0.0, 1e-3);
  EXPECT_NEAR(way_of_thumb(most + 40.0, -0.04), -0.02, 1e-3);  // gives way further
  EXPECT_NEAR(way_of_thumb(most - 150.0, 0.0), 0.0, 1e-12);    // never gave way
}

TEST(GripEffort, AStretchedThumbHoldsThreeTenthsMoreAtMost) {
  const double rest = most_of_thumb(0.0);
  EXPECT_NEAR(way_of_thumb(rest - 1.0, 0.0), 0.0, 1e-9);
  EXPECT_LT(way_of_thumb(rest + 20.0, 0.0), -0.005);
  // Stretched by 0.2 rad it holds 1.3 times the force that it has there.
  const hand::DigitMuscles there = hand::HandMuscles(hand()).in(hand::Finger::kThumb, [] {
    hand::Posture posture = bent();
    posture[hand::Dof::kThumbIpFlexion] -= 0.2;
    return posture;
  }());
  double isometric = 0.0;
  for (std::size_t t = 0; t < there.arm.size(); ++t) {
    isometric += 0.5 * there.strength[t] * std::max(0.0, there.arm[t][kThumbIp]);
  }
  EXPECT_NEAR(way_of_thumb(1.299 * isometric, -0.2), 0.0, 1e-3);
  EXPECT_LT(way_of_thumb(1.4 * isometric, -0.2), -0.01);
}

TEST(GripEffort, TwiceTheForceTakesTwiceTheStrengthInTheSamePosture) {
  // Passive moments don't grow with the force: the middle of the range, where they are small.
  GripEffort effort(hand(), 1.0, bent());
  effort.look(bent(), loaded({kMiddleFirst, kMiddleFirst + 2, kMiddleFirst + 3}));
  const double once = effort.strength_of(opening(1.0)).share;
  const double twice = effort.strength_of(opening(2.0)).share;
  EXPECT_GT(once, 0.05);
  EXPECT_NEAR(twice / once, 2.0, 0.12);
}

TEST(GripEffort, AWeakerHandNeedsMoreOfIts) {
  const auto share = [](double limit) {
    GripEffort effort(hand(), limit, bent());
    effort.look(bent(), loaded({kMiddleFirst, kMiddleFirst + 2, kMiddleFirst + 3}));
    return effort.strength_of(opening(1.0)).share;
  };
  EXPECT_NEAR(share(0.5) / share(1.0), 2.0, 0.03);
}

TEST(GripEffort, NoStrengthHoldsWhatNoMusclePullsAgainst) {
  // MCP pushed towards flexion, PIP and DIP open: the extensors that hold MCP open PIP the more.
  GripEffort effort(hand(), 1.0, bent());
  effort.look(bent(), loaded({kMiddleFirst + 1}));
  GripVector force = GripVector::Zero();
  force[kMiddleFirst + 1] = 1e6;
  EXPECT_FALSE(effort.strength_of(force).share <= 1.0);
}

TEST(GripEffort, ALoadAtALeverIsHeldByTheWrist) {
  const std::array<bool, kGripJoints> joints =
      loaded({kMiddleFirst, kMiddleFirst + 2, kMiddleFirst + 3});
  GripEffort effort(hand(), 1.0, bent());
  effort.look(bent(), joints);
  const GripEffort::Strength free = effort.strength_of(opening(0.3));
  EXPECT_FALSE(free.is_by_wrist);
  // 15 N at 150 mm that flex the wrist: 2.25 N m of the 7.1 N m that people have (ten men).
  effort.look(bent(), joints, {}, 2250.0);
  const GripEffort::Strength held = effort.strength_of(opening(0.3));
  EXPECT_TRUE(held.is_by_wrist);
  EXPECT_GT(held.share, free.share);
  EXPECT_LT(held.share, 1.0);
  EXPECT_EQ(held.load.wrist, 2250.0);
  effort.look(bent(), joints, {}, 45000.0);
  EXPECT_GT(effort.strength_of(opening(0.3)).share, 1.0);
}

/// The thumb and the index finger, straight.
std::pair<RoundCone, RoundCone> thumb_and_index(const hand::Posture& posture) {
  RoundCone thumb, index;
  for (const RoundCone& cone : FingerCones(hand()).posed(hand().skeleton, posture)) {
    if (cone.finger == hand::Finger::kThumb && cone.level == 2) thumb = cone;
    if (cone.finger == hand::Finger::kIndex && cone.level == 1) index = cone;
  }
  return {thumb, index};
}

TEST(ThumbPress, IsTheForceTimesThePathOfItsPointsOnBothDigits) {
  const hand::Posture posture = hand::reference_posture(hand().skeleton);
  const auto overlap_at = [&](const hand::Posture& there) {
    const auto [thumb, index] = thumb_and_index(there);
    return overlap(thumb, index);
  };
  const auto [thumb, index] = thumb_and_index(posture);
  const ThumbPress press = thumb_press(hand().skeleton, posture, thumb, index, 4.0);
  EXPECT_EQ(press.finger, hand::Finger::kIndex);
  EXPECT_NEAR(press.force, 2.0, 1e-12);  // two pulps, 2 mm each
  EXPECT_NEAR(press.stiffness, 2.0, 1e-12);
  EXPECT_EQ(thumb_press(hand().skeleton, posture, thumb, index, -1.0).force, 0.0);
  // Virtual work: an angle that deepens the overlap works against the force.
  constexpr double kStep = 1e-4;
  for (int joint = 0; joint < kGripJoints; ++joint) {
    hand::Posture plus = posture, minus = posture;
    plus[grip_dof(joint)] += kStep;
    minus[grip_dof(joint)] -= kStep;
    const double rate = (overlap_at(plus) - overlap_at(minus)) / (2.0 * kStep);
    // Radii that taper tilt the normal a little.
    EXPECT_NEAR(press.moment[joint], -rate, 0.1 * std::abs(rate) + 0.8) << joint;
  }
  EXPECT_TRUE(press.moment.tail<6>().isZero(0.0));  // nothing to the product
}

TEST(ThumbPress, CountsTheFingerThatMetTheThumb) {
  // What the product does to the digits and what they do to each other add up to nothing: no
  // strength is needed. Without their force on each other it would be.
  const hand::Posture posture = hand::reference_posture(hand().skeleton);
  const auto [thumb, index] = thumb_and_index(posture);
  const ThumbPress press = thumb_press(hand().skeleton, posture, thumb, index, 8.0);
  const GripVector outside = -press.force * press.moment;
  GripEffort effort(hand(), 1.0, bent());
  effort.look(posture, {}, {press});
  const GripEffort::Strength met = effort.strength_of(outside);
  EXPECT_LT(met.share, 0.01);
  for (int j = 0; j < kGripJoints; ++j) {
    EXPECT_NEAR(met.load.digit[j / hand::kDigitDofs][j % hand::kDigitDofs], 0.0, 1e-9);
  }
  ThumbPress none = press;
  none.force = 0.0;
  effort.look(posture, {}, {none});
  EXPECT_GT(effort.strength_of(outside).share, 0.05);
}

}  // namespace
}  // namespace palmar::grasp
