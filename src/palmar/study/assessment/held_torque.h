// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/contact/contact.h"
#include "palmar/geometry/distance/distance_field.h"
#include "palmar/grasp/indices/grasp_index.h"

namespace palmar::study {

/// About what a product is turned in the hand; product frame.
struct TorqueAxis {
  Vec3 axis = Vec3::UnitZ();  ///< any length but 0
  Vec3 at = Vec3::Zero();     ///< mm; a point that stays where it is
};

/// The largest torque about an axis, N mm, in the weaker of both senses, that friction of
/// `coefficient` holds at the pressures of a solved contact: the limit load of solve_friction(). It
/// says what a person can apply with a tool at that grip force, as far as the grip limits it; the
/// wrist's strength is none of it. 0 without friction or contact.
double held_torque(const contact::PreparedHand& prepared, const contact::ContactResult& contact,
                   const geometry::DistanceField& product, const TorqueAxis& about,
                   double coefficient);

inline constexpr const char* kHeldTorqueKey = "held_torque_n_mm";
/// As a row of the indices, group "stability".
grasp::GraspIndex held_torque_index(double torque);

}  // namespace palmar::study
