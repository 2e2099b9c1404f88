// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "palmar/contact/friction/friction_problem.h"
#include "palmar/core/progress.h"
#include "palmar/grasp/equilibrium/contact_forces.h"
#include "palmar/grasp/equilibrium/coordinates.h"
#include "palmar/grasp/equilibrium/effort_program.h"
#include "palmar/grasp/equilibrium/ligaments.h"
#include "palmar/grasp/equilibrium/thumb_meeting.h"
#include "palmar/hand/tendons/hand_muscles.h"

namespace palmar::grasp {

/// What shapes a rest with least effort beside the hand's own anatomy; all of it our choice
/// (docs/method/equilibrium.md).
struct EffortModel {
  // How far people vary in how they take a thing, one standard deviation: wide, so that E decides
  // only what effort leaves open.
  double flexion_spread = 0.6, abduction_spread = 0.3;  ///< rad
  double place_spread = 16.0;                           ///< mm
  double turn_spread = 0.4;                             ///< rad
  // What is missing costs more than any muscle could save: per N, and per N mm at arms of 30 mm.
  double force_price = 0.5, squeeze_price = 0.3, moment_price = 0.015;
  LigamentModel ligaments{};
};

/// What a hand is asked to do with what it holds.
struct EffortTask {
  std::optional<double> grip_force;  ///< N, as grip_force(); unset: as firm as at the start
  contact::Wrench load;              ///< on the product, about its origin, product frame
  double friction = 0.5;             ///< mu of skin on product
  double strength = 1.0;             ///< largest activation, times the muscles of HandMuscles
  hand::WristPosture wrist{};
  EffortModel model{};
};

/// A hand and a product at rest, or what is missing to that.
struct EffortRest {
  enum class Status { kSolved, kNoContact, kNoSolution };
  Status status = Status::kNoSolution;
  GripState state;
  Squeeze grip;
  Eigen::VectorXd activation;               ///< of `strength`: the digits' muscles, the wrist's
  GripVector missing = GripVector::Zero();  ///< to equilibrium, N and N mm
  double strongest_moment = 0.0;            ///< of the muscles about any angle, N mm
  double arm = 1.0;                         ///< of the contact forces about their centre, mm
  double wrist_load = 0.0;                  ///< moment of the load about the wrist, N mm
  GripVector contact_force = GripVector::Zero();  ///< with friction
  std::vector<ThumbPress> presses;
  std::array<bool, kGripJoints> is_loaded{};
  double friction_use = 0.0;
  std::vector<Vec3> friction_force;  ///< of the skin on the product, per skin vertex, N
  double moved = 0.0;                ///< of the product in the hand, mm
  Vec3 way = Vec3::Zero();           ///< the same, hand frame, mm
  double turned = 0.0;               ///< rad
  std::vector<double> merit;         ///< of every state that was taken; falls
  int iterations = 0;
  contact::ContactFallbacks fallbacks;
};

/// A power grip at rest with least effort: over the angles q of all digits, the product's pose T
/// and the activations a of all muscles,
///
///     min  sum a_i^3 + E(q, T)   so that   every angle, the product and the wrist are in
///                                equilibrium,   the grip force is the one asked for,   0 <= a <= 1
///
/// E, half the sum of squares of what angles and product have moved, each over how far people vary
/// in it, keeps the hold what it is. Equilibrium is an exact penalty: what can't be had is what is
/// missing. Each step solves the problem with forces linear in the motion (EffortProgram, damped
/// as Levenberg & Marquardt do) and is taken only if the merit, the value of the same problem with
/// the state held, falls. Derivatives of the contact are learnt on the way (Broyden 1965).
/// docs/method/equilibrium.md.
///
/// Deterministic. Throws Cancelled.
EffortRest rest_with_least_effort(const contact::PreparedHand& hand,
                                  const product::Product& product, const GripState& start,
                                  const EffortTask& task, const contact::ContactOptions& contact,
                                  const Progress& progress = {});

}  // namespace palmar::grasp
