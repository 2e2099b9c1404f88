// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/joint_strength.h"

#include <array>
#include <cmath>
#include <numbers>

namespace palmar::grasp {

namespace {

struct GripRow {
  double until;            // years
  double men, men_sd;      // kg
  double women, women_sd;  // kg
};
constexpr std::array<GripRow, 14> kGripRows = {{{20, 47.5, 9.7, 31.2, 6.2},
                                                {25, 50.3, 8.3, 32.5, 5.4},
                                                {30, 51.9, 8.3, 33.3, 5.6},
                                                {35, 53.5, 8.3, 33.7, 5.8},
                                                {40, 53.6, 9.8, 34.3, 6.1},
                                                {45, 53.4, 9.4, 34.8, 6.2},
                                                {50, 53.0, 8.6, 34.1, 6.1},
                                                {55, 50.9, 8.5, 32.9, 5.9},
                                                {60, 49.3, 8.4, 31.2, 5.5},
                                                {65, 47.6, 8.5, 29.9, 5.3},
                                                {70, 45.3, 7.4, 28.6, 5.2},
                                                {75, 42.7, 7.5, 27.3, 4.9},
                                                {80, 39.0, 7.9, 24.9, 4.5},
                                                {91, 34.0, 7.6, 22.1, 4.1}}};
constexpr double kNewtonPerKg = 9.80665;

const GripRow* grip_row(double age) {
  if (!(age >= 17.0)) return nullptr;
  for (const GripRow& row : kGripRows) {
    if (age < row.until) return &row;
  }
  return nullptr;
}

}  // namespace

std::optional<double> grip_strength(Sex sex, double age) {
  const GripRow* row = grip_row(age);
  if (row == nullptr) return std::nullopt;
  return kNewtonPerKg * (sex == Sex::kMale ? row->men : row->women);
}

std::optional<double> grip_strength_sd(Sex sex, double age) {
  const GripRow* row = grip_row(age);
  if (row == nullptr) return std::nullopt;
  return kNewtonPerKg * (sex == Sex::kMale ? row->men_sd : row->women_sd);
}

double strength_share(Grip grip) {
  constexpr double kGrip = 541.8;
  switch (grip) {
    case Grip::kTipPinch:
    case Grip::kFingerPush:  // the index finger's part in it
      return 78.3 / kGrip;
    case Grip::kLateral:
      return 117.4 / kGrip;
    case Grip::kPalmarPinch:
    case Grip::kTripod:
    case Grip::kPrecisionSphere:
    case Grip::kPrecisionDisk:
    case Grip::kPrismatic:
    case Grip::kWritingTripod:
    case Grip::kDistalType:
      return 109.9 / kGrip;
    default:
      return 1.0;
  }
}

double share_who_reach(double force, Grip grip, double age) {
  double share = 0.0;
  for (const Sex sex : {Sex::kMale, Sex::kFemale}) {
    const std::optional<double> mean = grip_strength(sex, age), sd = grip_strength_sd(sex, age);
    if (!mean || !sd) return 0.0;
    const double score = (force / strength_share(grip) - *mean) / *sd;
    share += 0.25 * std::erfc(score / std::numbers::sqrt2);  // half of each sex's share above it
  }
  return share;
}

}  // namespace palmar::grasp
