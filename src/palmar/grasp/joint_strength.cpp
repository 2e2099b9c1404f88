// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/joint_strength.h"

#include <array>

namespace palmar {

double flexion_strength(Dof dof) {
  constexpr double kMcp = 1.34, kDip = 0.31;  // of the PIP moment
  switch (dof) {
    case Dof::kIndexMcpFlexion:
      return kMcp * 1293.0;
    case Dof::kIndexPipFlexion:
      return 1293.0;
    case Dof::kIndexDipFlexion:
      return kDip * 1293.0;
    case Dof::kMiddleMcpFlexion:
      return kMcp * 1457.0;
    case Dof::kMiddlePipFlexion:
      return 1457.0;
    case Dof::kMiddleDipFlexion:
      return kDip * 1457.0;
    case Dof::kRingMcpFlexion:
      return kMcp * 908.0;
    case Dof::kRingPipFlexion:
      return 908.0;
    case Dof::kRingDipFlexion:
      return kDip * 908.0;
    case Dof::kLittleMcpFlexion:
      return kMcp * 475.0;
    case Dof::kLittlePipFlexion:
      return 475.0;
    case Dof::kLittleDipFlexion:
      return kDip * 475.0;
    default:
      return 0.0;
  }
}

std::optional<double> grip_strength(Sex sex, double age) {
  struct Row {
    double until;       // years
    double men, women;  // kg
  };
  constexpr std::array<Row, 14> kRows = {{{20, 47.5, 31.2},
                                          {25, 50.3, 32.5},
                                          {30, 51.9, 33.3},
                                          {35, 53.5, 33.7},
                                          {40, 53.6, 34.3},
                                          {45, 53.4, 34.8},
                                          {50, 53.0, 34.1},
                                          {55, 50.9, 32.9},
                                          {60, 49.3, 31.2},
                                          {65, 47.6, 29.9},
                                          {70, 45.3, 28.6},
                                          {75, 42.7, 27.3},
                                          {80, 39.0, 24.9},
                                          {91, 34.0, 22.1}}};
  if (!(age >= 17.0)) return std::nullopt;
  for (const Row& row : kRows) {
    if (age < row.until) return 9.80665 * (sex == Sex::kMale ? row.men : row.women);
  }
  return std::nullopt;
}

double strength_share(Grip grip) {
  constexpr double kGrip = 541.8;
  switch (grip) {
    case Grip::kTipPinch:
      return 78.3 / kGrip;
    case Grip::kLateral:
      return 117.4 / kGrip;
    case Grip::kPalmarPinch:
    case Grip::kTripod:
    case Grip::kPrecisionSphere:
      return 109.9 / kGrip;
    default:
      return 1.0;
  }
}

}  // namespace palmar
