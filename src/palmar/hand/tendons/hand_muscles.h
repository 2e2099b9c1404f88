// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "palmar/hand/tendons/digit_tendons.h"
#include "palmar/hand/tendons/joint_limits.h"
#include "palmar/hand/tendons/muscle_balance.h"
#include "palmar/hand/tendons/wrist_muscles.h"

namespace palmar::hand {

struct MuscleModel {
  TendonModel tendons{};
  double specific_tension = kSpecificTension;  ///< MPa
  /// passive_moments() count. Not for a posture that was measured: a few degrees off the coupling
  /// of DIP and PIP would outweigh what the hand holds.
  bool has_passive = true;
  LigamentModel ligaments{};
  JointStops stops{};  ///< without passive_moments()
  WristPosture wrist{};
};

/// Moments of outside forces about the angles of a digit, in their positive sense, N mm.
using DigitLoad = std::array<double, kDigitDofs>;

/// What muscles of a hand hold against.
struct HandLoad {
  std::array<DigitLoad, kFingerCount> digit{};  ///< indexed by Finger
  double wrist = 0.0;                           ///< in the sense of its flexion, N mm
};

/// What the muscles of one digit can do in a posture.
struct DigitMuscles {
  Finger finger{};
  std::vector<std::array<double, kDigitDofs>> arm;  ///< mm, in the order of tendons_of(finger)
  std::vector<WristVector> wrist_arm;               ///< mm
  std::vector<double> strength;                     ///< at full activation, N
  std::vector<double> fibre;                        ///< length at best, mm
  PassiveMoments passive;
  std::array<int, kDigitDofs> stop{};  ///< as MuscleProblem::stop
};

/// The muscles of all digits, for every question about strength: what a grip costs, whether it can
/// be held, how hard a hand grips at most.
///
/// Force at full activation: cross-section x specific tension (tendon.h) x force_length(). Fibre
/// lengths: of muscles of the forearm the model of Lee et al. 2015 (PLoS ONE 10:e0121712), of those
/// of the hand Jacobson et al. 1992 (J Hand Surg 17A:804-809, at second hand). They are taken to be
/// best in the position of function (MCP 45, PIP 45, DIP 25 degrees; the thumb's CMC as in the
/// reference posture, MP and IP in the middle of their ranges; the wrist extended by 30; our
/// choice), from which fibres lengthen and shorten as the tendon's path does, over the wrist by its
/// arm there (wrist_muscles.h). The thumb's are 2.8 times as strong as that: its
/// tendons are those of one specimen, which gives a third of the force that people's thumbs have;
/// chosen on one row of docs/method/strength.md. That makes up for their arms at the thumb; on the
/// wrist they pull with what their cross-sections give.
class HandMuscles {
 public:
  explicit HandMuscles(const Hand& hand, const MuscleModel& model = {});

  DigitMuscles in(Finger finger, const Posture& posture) const;
  const WristMuscles& wrist() const { return wrist_; }

 private:
  struct Muscle {
    TendonPath path;
    double force = 0.0;        ///< at full activation and best length, N
    double best_length = 0.0;  ///< of its fibres, mm
    double best_path = 0.0;    ///< path_length() there, mm
    WristVector wrist_arm = WristVector::Zero();
    double wrist_stretch = 0.0;  ///< mm
  };
  const Hand* hand_;
  bool has_passive_;
  LigamentModel ligaments_;
  JointStops stops_;
  WristMuscles wrist_;
  std::array<std::vector<Muscle>, kFingerCount> muscles_;
};

/// The muscles of one digit against a load on it; `strength`: the person's muscles over those of
/// HandMuscles. An angle without load is left out: nothing outside presses there, and the joint
/// lies against its ligaments.
MuscleProblem problem_of(const DigitMuscles& muscles, const DigitLoad& load, double strength,
                         int exponent = 3);

/// All digits given and the wrist in one problem: rows are the angles of the digits in their order,
/// then the wrist's flexion; columns the muscles of the digits in their order, then the wrist's.
/// The long muscles of the fingers pull at the wrist, too, so its extensors have to hold against a
/// grip. Deviation is left to what isn't muscle (our choice: docs/method/effort.md).
MuscleProblem problem_of(std::span<const DigitMuscles> digits, const WristMuscles& wrist,
                         const HandLoad& load, double strength, int exponent = 3);

}  // namespace palmar::hand
