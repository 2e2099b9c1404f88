// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/grasp/indices/convex_body.h"
#include "palmar/hand/anatomy.h"

namespace palmar::grasp {

using Vec2 = Eigen::Vector2d;
using Wrench6 = Eigen::Matrix<double, 6, 1>;  ///< force and moment

/// One place where the hand holds the product.
struct GraspContact {
  Vec3 position = Vec3::Zero();  ///< product frame, mm
  Vec3 normal = Vec3::UnitZ();   ///< unit, into the product: the way the hand pushes
  double friction = 0.0;         ///< mu; 0: a frictionless contact
  /// Largest moment about the normal per normal force, of a soft finger, mm; 0: a hard one.
  double torsion = 0.0;
  double normal_force = 0.0;  ///< N, where it is known
  hand::Region region{};      ///< of the hand
};

struct WrenchOptions {
  int sides = 8;  ///< of the polygon in a friction cone, 3 to 64
  /// Rings of the polyhedron in the ellipsoid of friction force and torsion, between its equator
  /// and each pole, 0 to 8. 0: a double pyramid, |t| / mu + |m| / torsion <= f.
  int torsion_rings = 0;
  /// Length by which moments are divided to compare them with forces, mm; unset: the largest
  /// distance of a contact from the reference point.
  std::optional<double> torque_scale = std::nullopt;
  BodyOptions body = {};
  void check() const;  ///< throws UsageError: field, value, allowed range
};

/// What bounds the forces (Ferrari, Canny 1992).
enum class WrenchNorm {
  kL1,   ///< the normal forces of all contacts sum to 1: one motor for the whole hand
  kLinf  ///< every normal force is at most 1: contacts are limited each on its own
};

enum class ClosureStatus {
  kForceClosure,   ///< any small disturbance can be met
  kNotClosed,      ///< some can't: `weakest` names one
  kRankDeficient,  ///< contact forces span less than the space: nothing meets `weakest` at all
  kNoContact
};
std::string_view name_of(ClosureStatus status);  ///< "force_closure", "not_closed", ...

/// The grasp wrench space: all wrenches that bounded forces within the friction cones put on the
/// product,
///
///     w = (f, (x - r) x f / rho),   f = f_n (n + t),  |t| <= mu,  + torsion about n,
///
/// r the reference point, rho the torque scale. A friction cone is replaced by the pyramid inside
/// it with `sides` edges, the first towards the reference point, so that the pyramids turn with the
/// grasp; force and torsion share the ellipsoid |t|^2 / mu^2 + m^2 / torsion^2 <= 1 (Howe, Cutkosky
/// 1996), replaced by a polyhedron inside it. Indices of a polyhedron inside are too low, never too
/// high: with 8 sides by up to 8 % of mu.
template <int D>
struct WrenchSpace {
  ClosureStatus status = ClosureStatus::kNoContact;
  WrenchNorm norm = WrenchNorm::kL1;
  double torque_scale = 1.0;  ///< that was used, mm
  /// epsilon: the largest wrench, in force and moment over torque_scale, that can be met whatever
  /// its direction, per unit of normal force. distance_lower <= epsilon <= distance. 0 without
  /// force closure. volume: of the wrench space.
  BodyMeasures<D> body;
  double epsilon = 0.0;
  /// Wrench (force, moment / torque_scale) whose opposite the grasp meets worst: unit.
  Eigen::Matrix<double, D, 1> weakest = Eigen::Matrix<double, D, 1>::Zero();
};

/// The largest distance of a contact from the reference point; 1 mm if it is 0.
double torque_scale_of(const std::vector<GraspContact>& contacts, const Vec3& reference);

/// Primitive wrenches of every contact, unit normal force each; one group per contact.
PointGroups<6> primitive_wrenches(const std::vector<GraspContact>& contacts, const Vec3& reference,
                                  double torque_scale, const WrenchOptions& options);

/// Throws UsageError on bad options or contacts (a normal that is no unit vector, friction below
/// 0).
WrenchSpace<6> measure_wrench_space(const std::vector<GraspContact>& contacts,
                                    const Vec3& reference, WrenchNorm norm,
                                    const WrenchOptions& options = {});

/// The same in a plane: wrench (f_x, f_y, moment / torque_scale), friction cones exact.
struct PlanarContact {
  Vec2 position = Vec2::Zero();  ///< mm
  Vec2 normal = Vec2::UnitY();   ///< unit, into the product
  double friction = 0.0;
};
WrenchSpace<3> measure_wrench_space(const std::vector<PlanarContact>& contacts,
                                    const Vec2& reference, WrenchNorm norm,
                                    const WrenchOptions& options = {});

}  // namespace palmar::grasp
