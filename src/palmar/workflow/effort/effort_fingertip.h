// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "palmar/effort/fingertip_force.h"
#include "palmar/hand/posture.h"
#include "palmar/hand/tendons/digit_tendons.h"
#include "palmar/workflow/hand/load_hand.h"

namespace palmar::workflow {

/// What people call an angle of one digit.
struct DigitAngleName {
  std::string_view name;
  hand::Dof dof{};
};
/// "mcp", "abduction", "pip", "dip"; of the thumb "cmc-flexion", "cmc-abduction", "mp", "ip".
std::vector<DigitAngleName> angle_names_of(hand::Finger finger);

struct DigitAngle {
  hand::Dof dof{};
  double angle = 0.0;  ///< rad
};

/// A fingertip that is held still while one tendon after the other is loaded.
struct FingertipRequest {
  HandChoice hand;
  hand::Finger finger = hand::Finger::kIndex;
  std::vector<DigitAngle> posture;    ///< of that finger; others are 0, or where their range begins
  std::vector<hand::Tendon> tendons;  ///< of that finger; empty: all of it
  double force = 1.0;                 ///< in the tendon, N; at most kLargestTendonForce
  hand::TendonModel model;
  void check() const;  ///< throws UsageError: setting, value, what is allowed
};

struct FingertipOutcome {
  std::vector<effort::FingertipForce> forces;  ///< by tendon
  hand::Posture posture;                       ///< of the hand
};

/// fingertip_force() of each tendon. Throws UsageError, also for an angle beyond the range of that
/// hand; InputError naming the file; NumericalError where the finger is too straight.
FingertipOutcome fingertip_forces(const FingertipRequest& request);

}  // namespace palmar::workflow
