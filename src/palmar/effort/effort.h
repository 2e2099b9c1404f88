// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "palmar/contact/contact.h"
#include "palmar/contact/friction/friction.h"
#include "palmar/effort/joint_moments.h"
#include "palmar/grasp/indices/grasp_index.h"
#include "palmar/hand/tendons/hand_muscles.h"

namespace palmar::effort {

struct EffortOptions {
  /// n of min sum (F / PCSA)^n; 3 after Crowninshield & Brand 1981 (spreads the load as endurance
  /// asks), 2 is also common.
  int exponent = 3;
  double specific_tension = hand::kSpecificTension;  ///< MPa, times the cross-section = strength
  double strength = 1.0;    ///< of the person over that of the cadavers' muscles; above 0
  bool joint_stops = true;  ///< a joint at the end of its range is held there by its ligaments
  /// Collateral ligaments of a finger's MCP are tight when it is bent: from this flexion on they
  /// take moments of abduction, both ways. rad (60 degrees); our choice, only with joint_stops.
  double tight_mcp_flexion = 1.0472;
  double stop_margin = 0.00873;  ///< rad (0.5 degrees); this near the end counts as at the end
  hand::TendonModel tendons{};
  hand::WristPosture wrist{};
  void check() const;  ///< throws UsageError: field, value, allowed range
};

enum class EffortStatus {
  kNoLoad,        ///< nothing touches the digit
  kHeld,          ///< the muscles hold the load
  kOverloaded,    ///< they can't; the missing moments are reported
  kNotConverged,  ///< numerical failure
};
std::string_view name_of(EffortStatus status);  ///< "no_load", "held", "overloaded", ...

/// One muscle.
struct TendonLoad {
  hand::Tendon tendon{};
  double force = 0.0;                                 ///< N
  double strength = 0.0;                              ///< largest force, N
  double activation = 0.0;                            ///< force / strength, 0 to 1
  std::array<double, hand::kDigitDofs> moment_arm{};  ///< mm, in the order of DigitEffort::joints
};

/// One degree of freedom; moments in the angle's positive sense, N mm. They add up to `missing`,
/// turned round: external + muscles + stop = -missing.
struct JointEffort {
  hand::Dof dof{};
  double external = 0.0;  ///< of the contact forces
  double muscles = 0.0;
  double stop = 0.0;     ///< of ligaments and slack muscles (joint_limits.h)
  double missing = 0.0;  ///< what the muscles would have to give beyond what they can
};

struct DigitEffort {
  hand::Finger finger{};
  EffortStatus status = EffortStatus::kNoLoad;
  double contact_force = 0.0;                        ///< sum of |force| on the digit, N
  std::array<JointEffort, hand::kDigitDofs> joints;  ///< from the palm outwards
  std::vector<TendonLoad> tendons;                   ///< in the order of tendons_of(finger)
  /// Least share of its own muscles' strength, whatever they do at the wrist; above 1: can't be
  /// held.
  double strength_share = 0.0;
  double kkt_residual = 0.0;  ///< see MuscleSolution
  int iterations = 0;
};

/// The wrist: moments in the sense of flexion, N mm; they add up to `missing`, turned round.
struct WristEffort {
  double external = 0.0;  ///< of the load
  double digits = 0.0;    ///< of the digits' long muscles
  double muscles = 0.0;   ///< of the wrist's own
  double missing = 0.0;
  std::array<double, hand::kWristMuscleCount> force{}, strength{};  ///< N, by WristMuscle
  double activation(hand::WristMuscle muscle) const;                ///< force over strength
};

/// What muscles do while a hand holds a product.
struct EffortResult {
  EffortStatus status = EffortStatus::kNoLoad;  ///< the worst of the digits
  std::string message;          ///< which moments are missing where: "index DIP flexion: 120 N mm"
  bool with_friction = false;   ///< friction forces are in the loads
  double contact_force = 0.0;   ///< sum of |force| on the five digits, N
  double tendon_force = 0.0;    ///< sum over all muscles, N
  double strength_share = 0.0;  ///< of all muscles, what the hold takes of a person
  std::array<DigitEffort, hand::kFingerCount> digits;  ///< indexed by Finger
  std::optional<WristEffort> wrist;                    ///< of a grasp at rest only
};

/// Tendon forces of every digit by static optimisation: contact forces (joint_moments.h) against
/// the muscles and passive moments of HandMuscles, muscle_balance.h. `at_rest`: moments of the
/// contact forces as the grasp at rest has them (Balance::joint_load), in place of those of rigid
/// phalanges; with them passive moments count, and the wrist's muscles have to hold what the load
/// and the fingers' muscles do there. Not modelled: the weight of the hand, muscles shared between
/// fingers. Deterministic; throws UsageError on bad options.
EffortResult assess_effort(const hand::Hand& hand, const hand::Posture& posture,
                           const contact::ContactResult& contact,
                           const geometry::Rigid3& product_from_hand,
                           const geometry::DistanceField& product,
                           const EffortOptions& options = {},
                           const contact::FrictionResult* friction = nullptr,
                           const hand::HandLoad* at_rest = nullptr);

/// The same for given forces on the skin.
EffortResult assess_effort(const hand::Hand& hand, const hand::Posture& posture,
                           std::span<const SkinForce> loads, const EffortOptions& options = {},
                           const hand::HandLoad* at_rest = nullptr);

/// The indices of group "effort".
grasp::GraspIndices effort_indices(const EffortResult& effort);

/// "index DIP flexion": a degree of freedom for people.
std::string plain_name_of(hand::Dof dof);

}  // namespace palmar::effort
