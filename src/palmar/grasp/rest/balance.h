// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "palmar/contact/contact.h"
#include "palmar/contact/friction/friction.h"
#include "palmar/core/progress.h"
#include "palmar/grasp/equilibrium/coordinates.h"
#include "palmar/grasp/grasp.h"
#include "palmar/grasp/task_force.h"
#include "palmar/hand/tendons/hand_muscles.h"
#include "palmar/product/product.h"

namespace palmar::grasp {

/// What a relaxed hand puts on what it lies on [N], the same for all hands of a comparison: its own
/// weight and, the forearm hanging between it and the elbow, the forearm's share,
///
///     F = m g (0.006 + 0.016 x 0.43 x 254 / (254 + 81)) = 8.2 N
///
/// with segment masses of 0.6 and 1.6 % of body mass, the forearm's centre of mass at 43 % of its
/// length from the elbow (Winter 2009, Biomechanics and Motor Control of Human Movement,
/// table 4.1), a body of 75 kg, 254 mm from elbow to wrist and the hand carried 81 mm beyond it
/// (choices).
inline constexpr double kRestingForce = 8.2;

/// Largest torque that may be asked for, N mm: no hand turns a handle that hard.
inline constexpr double kMostTurn = 5e4;

struct HoldAtRest;
struct NearbyRests;

struct BalanceOptions {
  bool is_on = true;
  /// Of skin on product while they settle; 0: none. 0.5: skin on usual products (Derler & Gerhardt
  /// 2012, Tribol Lett 45:1-27: mean 0.46, SD 0.15).
  double friction = 0.5;
  contact::ProductLoad load;  ///< weight and further forces; none by default
  // How firmly; at most one of the four. None: as firm as it was closed.
  std::optional<double> grip_force;  ///< N, as grip_force()
  std::optional<ShareOfStrength> share_of_strength;
  /// With what the load asks for, and the margin that people leave before a slip
  /// (holding_grip_force()); without a load or friction as firm as it was closed.
  bool holds_load = false;
  /// The product is turned about the grip axis with that torque [N mm], right-handed about the axis
  /// towards the thumb's side; the grip force is what that takes with people's margin before a slip
  /// (kGripMargin). With `activation` as hard as the hand can, in the sense of its sign.
  std::optional<double> turn;
  /// Instead of a grip force: as hard as a power grip can with no muscle above this activation, 0
  /// to `strength`. 1 with `strength` 1: as hard as the hand can.
  std::optional<double> activation;
  /// Largest activation: the person's muscles over those of HandMuscles.
  double strength = 1.0;
  /// The hold of another hand, from which a wrap by the whole hand comes to rest; null: from how it
  /// was closed. Where that fails it is tried from there, too.
  std::shared_ptr<const HoldAtRest> like;
  bool looks_beside = false;   ///< takes other_rest() where it has the lower merit
  bool looks_nearby = false;   ///< that, and finds NearbyRests of what comes to rest
  hand::WristPosture wrist{};  ///< of a power grip; changes what muscles can, not the picture
  /// N; nothing if a grasp of that grip stays as firm as it was closed, as hooked fingers always
  /// do: they carry and don't squeeze.
  std::optional<double> asked_grip_force(Grip grip) const;
  /// Whether no more is asked for than what holds the product: what that takes of a hand's strength
  /// is what it takes to keep the posture.
  bool is_light() const {
    return holds_load || (share_of_strength && share_of_strength->holds_only);
  }
  /// Where it comes from, to follow "107 N: ", or why nothing is asked for.
  std::string asked_words(Grip grip) const;
  void check() const;  ///< throws UsageError: field, value, allowed range
};

enum class BalanceStatus {
  kOff,
  kBalanced,   ///< forces and moments add up to less than 1 % of the grip force
  kSlipsOut,   ///< the product leaves the hand or turns in it, or muscles are too weak for the hold
  kSupported,  ///< the hand rests on it or pushes it with the force asked for; what the
               ///< product stands on carries that
  kNoContact,  ///< nothing is touched
  kFailed      ///< the contact couldn't be solved on the way
};
std::string_view name_of(BalanceStatus status);  ///< "balanced", "slips_out", ...

/// How a grasp came to rest.
struct Balance {
  BalanceStatus status = BalanceStatus::kOff;
  std::string message;          ///< one sentence for people
  double friction = 0.0;        ///< coefficient that was used
  contact::ProductLoad load;    ///< that was used; what hangs has the gravity that it came to
  double grip_force = 0.0;      ///< N, across the plane of largest squeeze
  double sum_of_normals = 0.0;  ///< N
  std::optional<double> turn;   ///< torque that the hand turns it with, N mm; where it was asked to
  double residual_force = 0.0;  ///< N; what the forces on the product add up to, load included
  double residual_moment = 0.0;  ///< N mm, about the centre of contact
  double residual_share = 0.0;   ///< the larger of force / grip force, moment / (grip force arm)
  double friction_use = 0.0;     ///< sum of tangential forces over the most they could be
  /// Least share of the person's strength with which the muscles of all digits and the wrist hold
  /// these contact forces and the load; nothing but for power grips that came to rest and aren't
  /// light.
  std::optional<double> strength_use;
  bool is_by_wrist = false;  ///< the muscles of the digits alone would need a smaller share
  /// Moments about the angles of the digits of contact forces, friction and of thumb and fingers on
  /// each other, and of the load about the wrist, of the grasp at rest.
  std::optional<hand::HandLoad> joint_load;
  double moved = 0.0;                ///< of the product in the hand since it was closed, mm
  double turned = 0.0;               ///< rad
  std::optional<Vec3> slip;          ///< kSlipsOut: unit direction, hand frame; unset where
                                     ///< nothing pushes it out
  std::vector<Vec3> friction_force;  ///< per skin vertex, of the skin on the product, product
                                     ///< frame, N
  std::shared_ptr<const NearbyRests> nearby;  ///< of what came to rest, if it was asked for
  std::optional<GripState> on_coarse_skin;    ///< where the search came to on it
  int iterations = 0;
  contact::ContactFallbacks fallbacks;  ///< of all contacts that were solved on the way
};

/// Lets product (6 degrees of freedom) and fingers come to rest against each other with least
/// effort (rest_with_least_effort()): contact forces, friction and load add up to nothing on the
/// product, about every angle of a digit and about the wrist, with the moments that the muscles
/// give. The palm holds against them. `grasp` gets the new posture and placement.
///
/// A precision grip that doesn't come to rest where fingertips were first put is tried at its
/// runners-up; `grasp` is then the first of those that does, and its message says so. What hooked
/// fingers carry isn't squeezed. A hand that rests on the product (along the way in which the palm
/// faces) or pushes it (straight into the surface) is asked for that force alone: what the product
/// stands on carries the rest.
///
/// Not coming to rest is a status, never an exception. Throws UsageError on bad options, Cancelled.
Balance balance_grasp(const contact::PreparedHand& hand, const product::Product& product,
                      Grasp& grasp, const BalanceOptions& options = {},
                      const contact::ContactOptions& contact = {}, const Progress& progress = {});

}  // namespace palmar::grasp
