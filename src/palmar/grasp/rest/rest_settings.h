// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "palmar/grasp/joint_strength.h"
#include "palmar/grasp/rest/balance.h"
#include "palmar/grasp/rest/friction_settings.h"
#include "palmar/grasp/task_force.h"

namespace palmar::grasp {

/// Sex and age, from which grip_strength() says how strong a person is.
struct PersonOfAge {
  Sex sex = Sex::kMale;
  double age = 30.0;  ///< years
};

/// Whether a grasp comes to rest and how firmly the hand grips, as people know it; BalanceOptions
/// is what becomes of it.
struct RestSettings {
  /// Off: the hand stays as it was closed to the limit depths, forces out of balance (Xie 2014).
  bool is_balanced = true;
  HandTask task = HandTask::kUsual;
  /// kTurn: torque about the grip axis that the product is turned with, N m; right-handed about the
  /// axis towards the thumb's side.
  std::optional<double> turn;
  // How firmly; at most one of the three, for a task that doesn't say it. None: what UsualTask says
  // of the products, with usual_share(), the same for all designs and hands of a comparison.
  /// As firm as closing to the limit depths made it, under a load a little more.
  bool limit_depths = false;
  std::optional<double> grip_force;      ///< N, as a dynamometer reads it
  std::optional<double> strength_share;  ///< of the strength below, above 0 to 1
  // The user's largest grip force; one of the two where a share is given.
  std::optional<double> strength;                    ///< N
  std::optional<PersonOfAge> person = std::nullopt;  ///< mean of that group (Steiber 2016)

  bool is_share_usual = false;  ///< nobody asked for `strength_share`

  /// Whether UsualTask decides.
  bool follows_product() const {
    return task == HandTask::kUsual && (is_usual() || is_share_usual);
  }
  /// Nothing is said about how firmly.
  bool is_usual() const {
    return is_balanced && !says_how_firmly(task) && !limit_depths && !grip_force && !strength_share;
  }
  /// Throws UsageError: setting, value, what is allowed.
  void check() const;
  /// `friction`: coefficient while it settles; unset: kUsualFriction. `heaviest` of all products of
  /// the comparison raises the usual grip force. Throws UsageError.
  BalanceOptions options(std::optional<double> friction, const HeaviestLoad& heaviest = {}) const;
  /// The load of a product: as given; to be held without one, the weight of a solid of
  /// kAssumedDensity; carried, with the acceleration of walking if none is given.
  FrictionSettings load(FrictionSettings given) const;
};

}  // namespace palmar::grasp
