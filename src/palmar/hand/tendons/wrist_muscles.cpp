// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/tendons/wrist_muscles.h"

#include <fmt/format.h>

#include <cmath>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/geometry/degrees.h"

namespace palmar::hand {
namespace {

/// Arms in mm; flexion and radial deviation are positive.
struct WristMotor {
  std::string_view name, anatomical;
  double force = 0.0;                                  // N
  double fibres = 0.0;                                 // mm
  double flexion_arm = 0.0, change = 0.0, rate = 1.0;  // arm cos(rate q) + change sin(rate q)
  double deviation_arm = 0.0;
};
constexpr std::array<WristMotor, kWristMuscleCount> kMotors = {
    {{"ecrl", "extensor carpi radialis longus", 304.9, 81.0, -10.07, 34.95, 0.075, 17.6},
     {"ecrb", "extensor carpi radialis brevis", 100.5, 58.5, -13.30, 10.46, 0.2138, 8.4},
     {"ecu", "extensor carpi ulnaris", 93.2, 62.2, -6.65, -0.17, 1.213, -24.5},
     {"fcr", "flexor carpi radialis", 74.0, 62.8, 14.93, 5.51, 0.3874, 10.0},
     {"fcu", "flexor carpi ulnaris", 128.9, 50.9, 14.96, 12.23, 0.2454, -23.1}}};

constexpr double kModelTension = 0.45;  // MPa
constexpr double kMeanPalm = 90.0;      // mm, from the wrist to the middle finger's MCP
constexpr double kForceLengthWidth = 0.45;
// mm, of the fingers' long extensors from the index to the little finger. The ring finger's was not
// measured: between its neighbours.
constexpr double kExtensorDeviation[4] = {4.7, -3.2, -10.5, -17.8};
constexpr WristPosture kFunction{};
// degrees; clinical norms of the template's wrist (Eaton)
constexpr double kLowest[2] = {-70.0, -35.0}, kHighest[2] = {75.0, 20.0};

double size_of(const Hand& hand) {
  return hand.skeleton.joint(JointId::kMiddleMcp).centre.norm() / kMeanPalm;
}

}  // namespace

void WristPosture::check() const {
  const double asked[2] = {flexion / geometry::kDegree, deviation / geometry::kDegree};
  constexpr const char* kNames[2] = {"flexion", "radial deviation"};
  for (int k = 0; k < 2; ++k) {
    if (asked[k] >= kLowest[k] - 1e-9 && asked[k] <= kHighest[k] + 1e-9) continue;
    throw UsageError(fmt::format("wrist: {} is {:.4g} degrees; {:.0f} to {:.0f} is allowed",
                                 kNames[k], asked[k], kLowest[k], kHighest[k]));
  }
}

std::string_view name_of(WristMuscle muscle) { return kMotors[index_of(muscle)].name; }

std::string_view anatomical_name_of(WristMuscle muscle) {
  return kMotors[index_of(muscle)].anatomical;
}

double force_length(double stretch, double best_length) {
  const double strain = stretch / best_length;
  return std::exp(-strain * strain / kForceLengthWidth);
}

double wrist_stretch(const WristVector& arm, const WristPosture& posture) {
  return -arm.x() * (posture.flexion - kFunction.flexion) -
         arm.y() * (posture.deviation - kFunction.deviation);
}

WristMuscles wrist_muscles(const Hand& hand, const WristPosture& posture, double tension) {
  WristMuscles result;
  const double size = size_of(hand);
  for (std::size_t i = 0; i < kMotors.size(); ++i) {
    const WristMotor& motor = kMotors[i];
    const auto arm_at = [&](double flexion) {
      return WristVector(size * (motor.flexion_arm * std::cos(motor.rate * flexion) +
                                 motor.change * std::sin(motor.rate * flexion)),
                         size * motor.deviation_arm);
    };
    result.arm[i] = arm_at(posture.flexion);
    // The arm changes by a few millimetres over the range: its mean gives the excursion.
    const double stretch =
        wrist_stretch(0.5 * (result.arm[i] + arm_at(kFunction.flexion)), posture);
    result.strength[i] =
        motor.force * tension / kModelTension * force_length(stretch, motor.fibres);
  }
  return result;
}

WristVector wrist_arm(const Hand& hand, Finger finger, Tendon tendon) {
  const double size = size_of(hand);
  switch (tendon) {
    case Tendon::kFdp:
      return {12.5 * size, 0.0};
    case Tendon::kFds:
      return {15.0 * size, 0.0};
    case Tendon::kEdc:
      return {-13.3 * size, kExtensorDeviation[static_cast<int>(finger) - 1] * size};
    case Tendon::kFpl:
      return {12.5 * size, 5.3 * size};
    case Tendon::kEpl:
    case Tendon::kEpb:
      return {-4.4 * size, 25.3 * size};
    case Tendon::kApl:
      return {0.5 * size, 25.2 * size};
    default:
      return WristVector::Zero();
  }
}

double wrist_moment(const Hand& hand, const Vec3& force, const Vec3& point, const Vec3& moment) {
  const Joint& wrist = hand.skeleton.joint(JointId::kWrist);
  const Vec3 about = moment + (point - wrist.centre).cross(force);
  return about.dot(hand.skeleton.dof(Dof::kWristFlexion).axis);
}

}  // namespace palmar::hand
