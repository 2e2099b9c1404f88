// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "palmar/core/progress.h"
#include "palmar/grasp/rest/rest_settings.h"
#include "palmar/workflow/effort/effort.h"

namespace palmar::workflow {

/// What one hand can do with a product at most.
struct CapacityRequest {
  ProductChoice product;
  HandChoice hand;
  grasp::GraspSettings grasp;
  contact::ContactModel model = contact::palmar_model();  ///< the equations of the skin
  contact::ContactOptions contact;                        ///< without the error band
  grasp::FrictionSettings friction;
  // How strong the person is; at most one of the two. None: usual_grip_strength().
  std::optional<double> strength;                           ///< N, on a dynamometer
  std::optional<grasp::PersonOfAge> person = std::nullopt;  ///< mean of that group (Steiber 2016)
  hand::WristPosture wrist{};
  std::optional<Vec3> torque_axis;  ///< product frame, any length but 0; unset: the grip axis
  NoteSink note = {};               ///< what was found in the product
  void check() const;               ///< throws UsageError: field, value, what is allowed
};

struct Capacity {
  double grip_force = 0.0;  ///< largest, as grip_force(), N
  /// Least share of the person's strength that holds it so (Balance::strength_use); 0 if nothing is
  /// held. At the largest force somewhat below 1: the last of it is forces that balance to 1 %.
  double activation = 0.0;
  double strength = 1.0;  ///< of the person's muscles over those of HandMuscles
  // Largest load that friction holds at that grip force.
  double torque = 0.0;               ///< about the torque axis, the smaller of both senses, N mm
  double push = 0.0;                 ///< by the hand along the grip axis to the thumb's side, N
  double pull = 0.0;                 ///< by the hand to the little finger's side, N
  double friction = 0.0;             ///< coefficient
  Vec3 axis = Vec3::UnitZ();         ///< grip axis towards the thumb's side, unit, product frame
  Vec3 torque_axis = Vec3::UnitZ();  ///< unit, product frame
  std::string limited_by;            ///< "muscles" (of the digits), "wrist", "slips" or "reach"
  std::string message;               ///< one sentence for people
  std::string hold;                  ///< how it is held, in words
  std::string grip;                  ///< name_of(Grip)
};

/// The largest grip force that a hand reaches on a product at rest with no muscle above its full
/// strength (rest_with_least_effort()), or as hard as the product stays in the hand; then the
/// largest torque about an axis through the middle of the grip and push and pull along the grip
/// axis that friction holds at that force (solve_friction(), limit load). Power grips only. Throws
/// UsageError (also for a product that isn't held in a power grip), InputError, Cancelled.
Capacity capacity_of_grip(const CapacityRequest& request, const Progress& progress = {});

}  // namespace palmar::workflow
