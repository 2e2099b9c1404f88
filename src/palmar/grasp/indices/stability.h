// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "palmar/contact/friction/friction.h"
#include "palmar/grasp/indices/contact_reduction.h"
#include "palmar/grasp/indices/grasp_index.h"
#include "palmar/grasp/indices/wrench_space.h"

namespace palmar::grasp {

struct StabilityOptions {
  ReductionOptions reduction;
  /// Bounds are close enough when they differ by a thousandth.
  WrenchOptions wrench{
      .body = {.distance_gap = 1e-3, .max_facets = 8000, .max_volume_facets = 22000}};
  bool with_linf = true;
  bool with_volume = true;  ///< of the L1 space; that of Linf is out of reach
  /// Contacts for the volume, 4 to 64: the hull of more has too many facets for 50 ms.
  int volume_contacts = 10;
  /// What is to be held; nothing: no grip force is asked for.
  std::optional<contact::ProductLoad> load;
  void check() const;  ///< throws UsageError: field, value, allowed range
};

enum class GripForceStatus {
  kHeld,
  kNoLoad,       ///< nothing is to be held: no force is needed
  kNotHoldable,  ///< no forces within the cones balance the load, however large: see `escape`
  kNoContact,
  kNotConverged
};
std::string_view name_of(GripForceStatus status);  ///< "held", "no_load", ...

/// The least that the hand must press to hold a load.
struct GripForce {
  GripForceStatus status = GripForceStatus::kNoContact;
  std::string message;      ///< one sentence for people where the load isn't held, else empty
  double sum = 0.0;         ///< least sum of normal forces, N, shared out as suits the load
  std::vector<Vec3> force;  ///< that holds it so, per contact, on the product, N
  /// Least factor on the known normal forces, their shares kept, with friction within the cones;
  /// nothing: no such factor holds the load.
  std::optional<double> factor;
  /// How the product begins to move though friction does what it can, where it isn't held; its
  /// fastest contact moves by 1 mm.
  contact::SmallMotion escape;
  double balance_error = 0.0;  ///< |load + forces| over the load, recomputed
};

/// Two linear programs over the contacts' friction polyhedra,
///
///     min sum f_n   such that   sum w(f) + load = 0,
///     min lambda    such that   f_n,i = lambda p_i  as well,   p_i: the known normal forces.
///
/// `load` about the origin of the product frame. Where the first is infeasible, what no contact
/// force can meet of the load (in force and moment over the torque scale) is a motion against which
/// no contact pushes while the load does work: the escape.
/// Source: Kerr, Roth 1986 (linear programs for grasp forces).
GripForce least_grip_force(const std::vector<GraspContact>& contacts, const contact::Wrench& load,
                           const Vec3& reference, const WrenchOptions& options = {});

/// How firmly the hand holds the product.
struct StabilityResult {
  std::string message;                 ///< one sentence for people, or empty
  std::vector<GraspContact> contacts;  ///< to which the patches of skin were reduced
  Vec3 reference = Vec3::Zero();       ///< of the moments: the centre of mass, mm
  double friction = 0.0;
  WrenchOptions wrench;  ///< that ran
  WrenchSpace<6> l1, linf;
  std::vector<GraspContact> volume_contacts;  ///< fewer, for the volume
  std::optional<WrenchSpace<6>> volume;  ///< L1 space of those, with StabilityOptions::with_volume
  std::optional<GripForce> grip;         ///< with StabilityOptions::load
};

/// Stability of a hand's contact, as if the contacts could press with any force (their friction
/// cones count, not the pressures found). Nothing touched is a status. Throws UsageError.
StabilityResult assess_stability(const hand::Hand& hand, const contact::ContactResult& contact,
                                 const Vec3& mass_centre, const StabilityOptions& options = {});

/// Rows of the group "stability".
GraspIndices to_indices(const StabilityResult& result);

}  // namespace palmar::grasp
