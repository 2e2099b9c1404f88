// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::contact {

/// Force and moment about the origin of the product frame, N and N mm.
struct Wrench {
  Vec3 force = Vec3::Zero();
  Vec3 moment = Vec3::Zero();
};

/// Small motion of a rigid body: a point x moves by translation + rotation x (x - about).
struct SmallMotion {
  Vec3 translation = Vec3::Zero();  ///< of the point `about`, mm
  Vec3 rotation = Vec3::Zero();     ///< axis times angle, rad
  Vec3 about = Vec3::Zero();        ///< mm
  Vec3 at(const Vec3& x) const { return translation + rotation.cross(x - about); }
};

/// One patch of skin that rubs on the product.
struct RubbingPatch {
  Vec3 position = Vec3::Zero();               ///< on the product, mm
  Vec3 normal = Vec3::UnitZ();                ///< of the product, unit, outward
  double limit = 0.0;                         ///< mu p: the tangential force at which it slips, N
  double radius = 1.0;                        ///< of the disc of its area, mm
  double shear_modulus = 0.01;                ///< G, MPa
  Vec3 rest = Vec3::Zero();                   ///< where it is on the skin at rest, mm
  Quat contact_from_rest = Quat::Identity();  ///< turns directions at rest to those in contact
  int body = 0;  ///< patches of different bodies (fingers) don't move each other
};

/// Limits of what friction can hold, from both sides.
struct HoldingLimit {
  bool has_converged = false;
  /// Largest factor by which the load may be multiplied: a set of tractions that balances it is
  /// known (`force`). Infinite for no load, 0 if friction can't hold it at all.
  double factor = 0.0;
  double upper_factor = 0.0;  ///< proven: more can't be held
  std::vector<Vec3> force;    ///< of the skin on the product at `factor`, N
  SmallMotion slip;           ///< how the product begins to slip; the fastest contact moves by 1 mm
  int iterations = 0;
};

/// The largest multiple of a load that friction alone can balance,
///
///     max s   such that   sum t_i = -s F,   sum x_i x t_i = -s M,   t_i . n_i = 0,
///                         |t_i| <= limit_i,
///
/// a convex problem (one disc per patch), solved by a barrier method; every slip motion v proves
/// s <= sum limit_i |v_i| / (power of the load), and the motion returned proves it within 1e-6. It
/// doesn't depend on the elasticity of the skin (limit theorems of plasticity: Drucker 1954).
///
/// Source: Boyd, Vandenberghe 2004, Convex Optimization, sections 11.2, 11.3.
HoldingLimit holding_limit(const std::vector<RubbingPatch>& patches, const Wrench& load);

/// Elastic answer of the skin to a load that friction holds.
struct StickSlip {
  bool has_converged = false;
  std::vector<Vec3> force;     ///< of the skin on the product, N
  std::vector<double> slip;    ///< distance by which the product slipped over the patch, mm
  SmallMotion motion;          ///< of the product
  double balance_error = 0.0;  ///< |load + friction|, over the load; recomputed
  double elastic_error = 0.0;  ///< largest misfit of the displacements, mm; recomputed
  int iterations = 0;
};

/// Stick and slip (Cattaneo 1938, Mindlin 1949): the product moves a little, drags the skin along
/// where |t_i| < limit_i, and slides over it, against t_i, where |t_i| = limit_i. The load is
/// applied at once and in proportion. With C the tangential response of the skin (per pair of
/// patches T_i^T Q_i tangential_response() Q_j^T T_j / sqrt(G_i G_j), T a base of the tangent
/// plane, Q = contact_from_rest), the tractions are those of least elastic energy,
///
///     min 1/2 t^T C t   such that   the load is balanced and |t_i| <= limit_i,
///
/// unique as C is positive definite; the motion of the product is the multiplier of the balance.
/// Solved by a primal-dual interior-point method from `start`, which holds the load with room to
/// spare: `limit` of the same load, with a factor above 1. One Cholesky factor per body and step.
///
/// Source: Johnson 1985, sections 7.2, 7.3; Duvaut, Lions 1976, chapter III (given friction);
/// Boyd, Vandenberghe 2004, section 11.7.
StickSlip solve_stick_slip(const std::vector<RubbingPatch>& patches, const Wrench& load,
                           const HoldingLimit& limit);

}  // namespace palmar::contact
