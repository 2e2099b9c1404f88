// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/tendons/grip_muscles.h"

#include <cmath>

#include "palmar/core/enum_index.h"
#include "palmar/geometry/degrees.h"

namespace palmar {
namespace {

// Lee et al. 2015 (OpenSim "2nd Hand"), mm, index to little finger.
constexpr std::array<double, 4> kFdpFibres = {74.9, 83.5, 79.8, 74.9};
constexpr std::array<double, 4> kFdsFibres = {83.5, 74.9, 73.6, 51.5};
constexpr double kForceLengthWidth = 0.45;  // Thelen 2003
constexpr std::array<double, 3> kBestPosture = {45.0 * kDegree, 45.0 * kDegree, 25.0 * kDegree};

}  // namespace

GripMuscles::GripMuscles(const Hand& hand) : hand_(&hand) {
  for (int f = 1; f < kFingerCount; ++f) {
    const auto finger = static_cast<Finger>(f);
    Posture best = reference_posture(hand.skeleton);
    const PosedDigit reference = pose_digit(hand.skeleton, finger, best);
    std::size_t level = 0;
    for (const Dof dof : reference.dof) {
      if (is_flexion(dof)) best[dof] = kBestPosture[level++];
    }
    const PosedDigit digit = pose_digit(hand.skeleton, finger, best);
    const DigitTendons tendons = route_tendons(hand, finger);
    const std::span<const Tendon> names = tendons_of(finger);
    for (std::size_t t = 0; t < names.size(); ++t) {
      if (names[t] != Tendon::kFdp && names[t] != Tendon::kFds) continue;
      Muscle muscle;
      muscle.best_length = (names[t] == Tendon::kFdp ? kFdpFibres : kFdsFibres)[f - 1];
      muscle.path = tendons.path[t];
      muscle.force = kSpecificTension * cross_section_of(finger, names[t]);
      muscle.best_path = path_length(muscle.path, digit);
      muscles_[f].push_back(std::move(muscle));
    }
  }
}

std::array<double, 3> GripMuscles::flexion_moments(Finger finger, const Posture& posture) const {
  const PosedDigit digit = pose_digit(hand_->skeleton, finger, posture);
  std::array<double, 3> moments{};
  for (const Muscle& muscle : muscles_[index_of(finger)]) {
    const double stretch =
        (path_length(muscle.path, digit) - muscle.best_path) / muscle.best_length;
    const double force = muscle.force * std::exp(-stretch * stretch / kForceLengthWidth);
    const std::array<double, kDigitDofs> arms = moment_arms(muscle.path, digit);
    std::size_t level = 0;
    for (std::size_t k = 0; k < arms.size(); ++k) {
      if (is_flexion(digit.dof[k])) moments[level++] += force * arms[k];
    }
  }
  return moments;
}

}  // namespace palmar
