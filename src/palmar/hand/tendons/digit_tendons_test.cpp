// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/tendons/digit_tendons.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"
#include "palmar/hand/mirror.h"
#include "palmar/hand/tendons/tendon_test_hand.h"

namespace palmar::hand {
namespace {

using effort_test::kFingers;
using effort_test::plain_hand;
using effort_test::posture_of;

enum Axis { kAbduction, kMcp, kPip, kDip };

/// Moment arm about an axis by its name; the digit lists its axes from the palm outwards.
double arm_of(const DigitTendons& tendons, const Hand& hand, const Posture& posture, Tendon tendon,
              Axis axis) {
  const PosedDigit digit = pose_digit(hand.skeleton, tendons.finger, posture);
  const char* const names[] = {"mcp_abduction", "mcp_flexion", "pip_flexion", "dip_flexion"};
  const auto arms = moment_arms(tendons, digit);
  for (std::size_t t = 0; t < arms.size(); ++t) {
    if (tendons_of(tendons.finger)[t] != tendon) continue;
    for (std::size_t k = 0; k < kDigitDofs; ++k) {
      if (name_of(digit.dof[k]).ends_with(names[axis])) return arms[t][k];
    }
  }
  ADD_FAILURE() << "no such tendon or axis";
  return 0.0;
}

/// Everything of one muscle into one slip, so that its arm can be read.
ExtensorHood hood_of_edc(HoodShare share) {
  ExtensorHood hood;
  hood.edc = share;
  return hood;
}

struct ArmRow {
  const char* slip;  ///< as in the literature: TE, ES, RB, UB, LE and the muscles
  Axis axis;
  double at_0, at_30, at_60;  ///< mm, joint flexed by 0, 30, 60 degrees
};

double slip_arm(FingerPoints points, const std::string& slip, Axis axis, double angle) {
  const Hand hand = plain_hand();
  ExtensorHood hood;
  Tendon tendon = Tendon::kEdc;
  if (slip == "ES") hood = hood_of_edc({1.0, 0.0, 0.0});
  if (slip == "RB" || slip == "TE") hood = hood_of_edc({0.0, 1.0, 0.0});
  if (slip == "UB") hood = hood_of_edc({0.0, 0.0, 1.0});
  if (slip == "FDP") tendon = Tendon::kFdp;
  if (slip == "FDS") tendon = Tendon::kFds;
  if (slip == "RI") tendon = Tendon::kRi;
  if (slip == "LU") tendon = Tendon::kLum;
  if (slip == "UI") tendon = Tendon::kUi;
  const Posture posture = posture_of(Finger::kMiddle, axis == kMcp ? angle : 0.0,
                                     axis == kPip ? angle : 0.0, axis == kDip ? angle : 0.0);
  return arm_of(route_tendons(hand, Finger::kMiddle, {points, hood}), hand, posture, tendon, axis);
}

// Arms about the flexion axes of a middle finger with O2O3 = 23.63 mm, by chords of the published
// points, computed apart from this program (rounded to 0.01 mm; extensors held to their value in
// the straight finger). Lines that cross the plane of flexion obliquely differ by less than 0.03
// mm.
constexpr double kRounding = 0.05;  // mm

TEST(DigitTendons, ArmsOfAn1979) {
  const ArmRow rows[] = {{"TE", kDip, -3.96, -3.96, -3.96},  {"FDP", kDip, 4.36, 5.62, 6.17},
                         {"FDP", kPip, 6.36, 8.84, 10.66},   {"RB", kPip, -2.67, -1.63, -0.36},
                         {"UB", kPip, -2.16, -1.14, 0.03},   {"FDS", kPip, 5.02, 7.56, 9.55},
                         {"ES", kPip, -5.57, -5.57, -5.57},  {"FDP", kMcp, 9.81, 12.03, 13.16},
                         {"FDS", kMcp, 11.79, 14.03, 15.20}, {"RI", kMcp, 8.15, 11.67, 14.28},
                         {"LU", kMcp, 9.88, 13.33, 15.79},   {"UI", kMcp, 3.65, 6.93, 9.60},
                         {"LE", kMcp, -9.16, -9.16, -9.16}};
  for (const ArmRow& row : rows) {
    EXPECT_NEAR(slip_arm(FingerPoints::kAn1979, row.slip, row.axis, 0), row.at_0, kRounding)
        << row.slip;
    EXPECT_NEAR(slip_arm(FingerPoints::kAn1979, row.slip, row.axis, 30), row.at_30, kRounding)
        << row.slip;
    EXPECT_NEAR(slip_arm(FingerPoints::kAn1979, row.slip, row.axis, 60), row.at_60, kRounding)
        << row.slip;
  }
}

TEST(DigitTendons, ArmsOfSynek2019) {
  // The profundus at 60 degrees of the DIP: the chord alone would fall to 3.61 mm; its largest arm
  // is the distance of the insertion from the axis, 23.63 hypot(0.17 - 0.0352, 0.1277) = 4.39 mm.
  const ArmRow rows[] = {{"TE", kDip, -3.72, -3.72, -3.72},  {"FDP", kDip, 3.90, 4.39, 4.39},
                         {"FDP", kPip, 6.83, 9.38, 11.24},   {"RB", kPip, -2.52, -1.47, -0.22},
                         {"UB", kPip, -2.22, -1.18, 0.02},   {"FDS", kPip, 3.42, 5.68, 7.46},
                         {"ES", kPip, -5.44, -5.44, -5.44},  {"FDP", kMcp, 10.14, 12.87, 14.70},
                         {"FDS", kMcp, 10.39, 13.74, 16.14}, {"RI", kMcp, 2.54, 4.95, 6.78},
                         {"LU", kMcp, 9.26, 12.72, 15.26},   {"UI", kMcp, 3.25, 6.44, 9.05},
                         {"LE", kMcp, -8.91, -8.91, -8.91}};
  for (const ArmRow& row : rows) {
    EXPECT_NEAR(slip_arm(FingerPoints::kSynek2019, row.slip, row.axis, 0), row.at_0, kRounding)
        << row.slip;
    EXPECT_NEAR(slip_arm(FingerPoints::kSynek2019, row.slip, row.axis, 30), row.at_30, kRounding)
        << row.slip;
    EXPECT_NEAR(slip_arm(FingerPoints::kSynek2019, row.slip, row.axis, 60), row.at_60, kRounding)
        << row.slip;
  }
}

TEST(DigitTendons, FlexorsKeepTheirArmBeyondStraight) {
  // Landsmeer's first model: the flexor lies on the joint in hyperextension.
  EXPECT_NEAR(slip_arm(FingerPoints::kAn1979, "FDP", kMcp, -20), 9.81, kRounding);
}

TEST(DigitTendons, IntrinsicsMoveTheFingerToTheirSide) {
  const Hand hand = plain_hand();
  const Posture posture = posture_of(Finger::kMiddle, 20, 20, 20);
  const DigitTendons tendons = route_tendons(hand, Finger::kMiddle);
  EXPECT_GT(arm_of(tendons, hand, posture, Tendon::kRi, kAbduction), 5.0);
  EXPECT_GT(arm_of(tendons, hand, posture, Tendon::kLum, kAbduction), 5.0);
  EXPECT_LT(arm_of(tendons, hand, posture, Tendon::kUi, kAbduction), -5.0);
  // They flex the MCP and extend PIP and DIP.
  for (const Tendon tendon : {Tendon::kRi, Tendon::kLum, Tendon::kUi}) {
    EXPECT_GT(arm_of(tendons, hand, posture, tendon, kMcp), 0.0);
    EXPECT_LT(arm_of(tendons, hand, posture, tendon, kPip), 0.0);
    EXPECT_LT(arm_of(tendons, hand, posture, tendon, kDip), 0.0);
  }
}

TEST(DigitTendons, ArmsGrowWithTheHand) {
  const Hand hand = plain_hand(), large = plain_hand(1.25);
  std::mt19937 random(11);
  for (const Finger finger : kFingers) {
    const Posture posture = effort_test::random_posture(hand.skeleton, finger, random);
    const auto arms =
        moment_arms(route_tendons(hand, finger), pose_digit(hand.skeleton, finger, posture));
    const auto larger =
        moment_arms(route_tendons(large, finger), pose_digit(large.skeleton, finger, posture));
    for (std::size_t t = 0; t < arms.size(); ++t) {
      for (std::size_t k = 0; k < kDigitDofs; ++k) {
        EXPECT_NEAR(larger[t][k], 1.25 * arms[t][k], 1e-6);  // mm; the CMC's rate is a difference
      }
    }
  }
}

TEST(DigitTendons, LeftHandHasTheArmsOfTheRight) {
  const Hand hand = plain_hand(), left = mirrored(hand);
  std::mt19937 random(13);
  for (const Finger finger : kFingers) {
    const Posture posture = effort_test::random_posture(hand.skeleton, finger, random);
    const auto right_arms =
        moment_arms(route_tendons(hand, finger), pose_digit(hand.skeleton, finger, posture));
    const auto left_arms =
        moment_arms(route_tendons(left, finger), pose_digit(left.skeleton, finger, posture));
    for (std::size_t t = 0; t < right_arms.size(); ++t) {
      for (std::size_t k = 0; k < kDigitDofs; ++k) {
        EXPECT_NEAR(left_arms[t][k], right_arms[t][k], 1e-9)
            << name_of(finger) << " " << name_of(tendons_of(finger)[t]);
      }
    }
  }
}

TEST(DigitTendons, BadHoodIsNamed) {
  TendonModel model;
  model.hood.edc = {0.6, 0.3, 0.3};
  EXPECT_THAT([&] { route_tendons(plain_hand(), Finger::kIndex, model); },
              testing::ThrowsMessage<UsageError>(testing::HasSubstr("extensor digitorum add up")));
  model.hood.edc = {-0.1, 0.3, 0.3};
  EXPECT_THAT([&] { route_tendons(plain_hand(), Finger::kIndex, model); },
              testing::ThrowsMessage<UsageError>(testing::HasSubstr("0 to 1 is allowed")));
}

TEST(Tendon, NamesReadBack) {
  for (const Finger finger : kFingers) {
    EXPECT_EQ(tendons_of(finger).size(), finger == Finger::kThumb ? 8U : 6U);
    for (const Tendon tendon : tendons_of(finger)) {
      EXPECT_EQ(tendon_named(name_of(tendon)), tendon);
      EXPECT_GT(cross_section_of(finger, tendon), 5.0);  // mm^2
    }
  }
  EXPECT_EQ(tendon_named("fcu"), std::nullopt);
  EXPECT_THROW(cross_section_of(Finger::kThumb, Tendon::kFdp), Error);
}

TEST(Tendon, StrengthIsThatOfPublishedModels) {
  // Largest forces in the OpenSim hand of Lee et al. 2015, N; other specific tensions there (35 to
  // 40 N/cm^2) make them 0 to 35 % lower than ours.
  struct Row {
    Finger finger;
    Tendon tendon;
    double force;
  };
  for (const Row& row :
       {Row{Finger::kLittle, Tendon::kFds, 16.55}, Row{Finger::kRing, Tendon::kFds, 57.9},
        Row{Finger::kMiddle, Tendon::kFds, 91.03}, Row{Finger::kIndex, Tendon::kFds, 61.24},
        Row{Finger::kLittle, Tendon::kFdp, 79.65}, Row{Finger::kRing, Tendon::kFdp, 64.08},
        Row{Finger::kMiddle, Tendon::kFdp, 81.65}, Row{Finger::kIndex, Tendon::kFdp, 68.27},
        Row{Finger::kMiddle, Tendon::kEdc, 35.32}, Row{Finger::kThumb, Tendon::kFpl, 77.2},
        Row{Finger::kThumb, Tendon::kEpl, 39.46}, Row{Finger::kThumb, Tendon::kEpb, 14.2},
        Row{Finger::kThumb, Tendon::kApl, 59.53}}) {
    const double ratio = kSpecificTension * cross_section_of(row.finger, row.tendon) / row.force;
    EXPECT_GT(ratio, 1.0) << name_of(row.finger) << " " << name_of(row.tendon);
    EXPECT_LT(ratio, 1.55) << name_of(row.finger) << " " << name_of(row.tendon);
  }
}

}  // namespace
}  // namespace palmar::hand
