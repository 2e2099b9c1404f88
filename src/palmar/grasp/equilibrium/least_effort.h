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
#include "palmar/grasp/equilibrium/digit_meeting.h"
#include "palmar/grasp/equilibrium/volar_gaps.h"
#include "palmar/hand/tendons/hand_muscles.h"

namespace palmar::grasp {

/// What shapes a rest with least effort beside the hand's own anatomy; all of it our choice
/// (docs/method/equilibrium.md).
struct EffortModel {
  // How far people vary in how they take a thing, one standard deviation.
  double flexion_spread = 0.35, abduction_spread = 0.3;  ///< rad
  double place_spread = 5.0;                             ///< mm
  double turn_spread = 0.25;                             ///< rad
  double gap_spread = 2.0;  ///< mm; by which phalanges and pads stay off the product
  // What is missing costs more than any muscle could save: per N, and per N mm at arms of 30 mm.
  double force_price = 1.5, squeeze_price = 0.9, moment_price = 0.045;
  double light_grip = 107.0;  ///< N; below it prices grow as the force gets less: soft skin gives
                              ///< way a lot for little force
  double nothing = 0.1;       ///< N; less that is missing is nothing to a hand: the weight of 10 g
  hand::LigamentModel ligaments{};
};

/// What a task measures as its force.
enum class EffortMeasure {
  kSqueeze,  ///< grip_force()
  kPush,     ///< that on the product along a direction; what it stands on carries all else
  kTurn,     ///< the torque on the product about an axis, N mm; what it turns resists that
  kHang,     ///< that on the product, which turns until its centre of mass hangs below the fingers
  kNone      ///< nothing: hooked fingers carry what pulls at them
};

/// What a hand is asked to do with what it holds.
struct EffortTask {
  EffortMeasure measure = EffortMeasure::kSqueeze;
  Vec3 along = Vec3::UnitZ();    ///< of a push or turn: unit, product frame
  Vec3 hangs_at = Vec3::Zero();  ///< of what hangs by `force`: centre of mass, product frame, mm
  /// What is measured, N or N mm; unset: as firm as it was closed, under a load half of it over mu
  /// more. A turn needs it or `is_hardest`; of what hangs it is the weight, and has to be set.
  std::optional<double> force;
  bool is_hardest = false;  ///< as hard as `strength` can, whatever `force` says
  /// Share with which the gap of each part of the hand counts: 0 where it takes no part in the
  /// hold.
  VolarVector takes_part = VolarVector::Ones();
  contact::Wrench load;   ///< on the product, about its origin, product frame
  double friction = 0.5;  ///< mu of skin on product
  double strength = 1.0;  ///< largest activation, times the muscles of HandMuscles
  hand::WristPosture wrist{};
  EffortModel model{};
};

/// A hand and a product at rest, or what is missing to that.
struct EffortRest {
  enum class Status { kSolved, kNoContact, kNoSolution };
  Status status = Status::kNoSolution;
  GripState start;              ///< closed: skin sticks where it is there
  Vec3 held_at = Vec3::Zero();  ///< centre of contact there, hand frame, mm
  double asked = 0.0;           ///< force that the search was for, N
  GripState state;
  std::optional<GripState> on_coarse_skin;  ///< where the search came to on it
  Squeeze grip;
  double force = 0.0;                       ///< what the task measures, N or N mm; else the squeeze
  Eigen::VectorXd activation;               ///< of `strength`: the digits' muscles, the wrist's
  GripVector missing = GripVector::Zero();  ///< to equilibrium, N and N mm
  double strongest_moment = 0.0;            ///< of the muscles about any angle, N mm
  double arm = 1.0;                         ///< of the contact forces about their centre, mm
  /// Moments about the angles of the digits of contact, friction and of digits on each
  /// other, and of the task's load about the wrist.
  hand::HandLoad load;
  double share = 0.0;        ///< least share of `strength` that holds it so
  bool is_by_wrist = false;  ///< the muscles of the digits alone would need less
  double friction_use = 0.0;
  std::vector<Vec3> friction_force;      ///< of the skin on the product, per skin vertex, N
  Vec3 force_on_product = Vec3::Zero();  ///< of all contact and friction, product frame, N
  double moved = 0.0;                    ///< of the product in the hand, mm
  Vec3 way = Vec3::Zero();               ///< the same, hand frame, mm
  double turned = 0.0;                   ///< rad
  std::vector<double> merit;             ///< of every state that the last search took; falls
  int iterations = 0;
  contact::ContactFallbacks fallbacks;
};

/// Where a search begins that doesn't come from the closed hand: a rest that is near, and where
/// that rested on the coarse skin.
struct SearchStart {
  GripState on_skin;
  std::optional<GripState> on_coarse_skin;
};

/// A hold at rest with least effort: over the angles q of all digits, the product's pose T
/// and the activations a of all muscles,
///
///     min  sum a_i^3 + E(q, T)   so that   every angle, the product and the wrist are in
///                                equilibrium,   the force is the one asked for,   0 <= a <= 1
///
/// A product that is pushed stands fast: only the force along the push is asked for. What hangs is
/// turned by its weight: the force has any direction, and no moment about the centre of mass.
///
/// E keeps the hold what it is: half the sum of squares of what angles and product have moved, each
/// over how far people vary in it, and sqrt(1 + g^2) - 1 for each gap g that a phalanx or pad
/// which takes part leaves to the product (VolarGaps), over its spread. Equilibrium is an exact
/// penalty: what can't be had is what is missing.
///
/// Starts from the closed hand. Each step solves the problem with forces linear in the motion
/// (EffortProgram, damped as Levenberg & Marquardt do), comes back to the equilibrium by
/// second-order corrections and is taken only if the merit, the value of the same problem with the
/// state held, falls. First on the coarse skin (PreparedHand::coarse()), at 0.6 of the grip force,
/// but 30 N at least, and at all of it, then on the whole; where only some parts of the hand hold,
/// on the whole at once: they touch too little for the coarse skin. docs/method/equilibrium.md.
///
/// `from`: where the search begins, on the whole skin at once; with a state on the coarse skin the
/// search goes on there first, and the whole skin begins as far from its own state. Deterministic.
/// Throws Cancelled.
EffortRest rest_with_least_effort(const contact::PreparedHand& hand,
                                  const product::Product& product, const GripState& closed,
                                  const EffortTask& task, const contact::ContactOptions& contact,
                                  const Progress& progress = {}, const SearchStart* from = nullptr);

/// Where that search comes to on the coarse skin, from the closed hand or a state near the end.
/// Nothing where only some parts of the hand hold, or nothing is touched. Throws Cancelled.
std::optional<GripState> rest_on_coarse_skin(const contact::PreparedHand& hand,
                                             const product::Product& product,
                                             const GripState& closed, const EffortTask& task,
                                             const contact::ContactOptions& contact,
                                             const Progress& progress = {},
                                             const GripState* from = nullptr);

/// What a rest becomes, by its derivatives, if the force asked for changes by a factor and the
/// product to `changed`, whose skin sticks where it did on the first.
GripState rest_after_change(const contact::PreparedHand& hand, const product::Product& product,
                            const product::Product& changed, const EffortRest& rest, double force,
                            const EffortTask& task, const contact::ContactOptions& contact);

}  // namespace palmar::grasp
