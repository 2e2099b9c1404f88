// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "palmar/grasp/grip.h"
#include "palmar/grasp/joint_strength.h"
#include "palmar/grasp/rest/balance.h"

namespace palmar {

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
  // How firmly; unset: as firm as closing to the limit depths. At most one of the two.
  std::optional<double> grip_force;      ///< N, as a dynamometer reads it
  std::optional<double> strength_share;  ///< of the strength below, above 0 to 1
  // The user's largest grip force; one of the two where a share is given.
  std::optional<double> strength;                    ///< N
  std::optional<PersonOfAge> person = std::nullopt;  ///< mean of that group (Steiber 2016)

  /// Throws UsageError: setting, value, what is allowed.
  void check() const;
  /// `friction`: coefficient while it settles; unset: kUsualFriction. `grip` turns a share of the
  /// grip strength into that of a pinch; unset: a power grip. Throws UsageError.
  BalanceOptions options(std::optional<double> friction, std::optional<Grip> grip) const;
};

}  // namespace palmar
