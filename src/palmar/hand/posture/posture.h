// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "palmar/hand/anatomy.h"

namespace palmar {

/// Angles of the 23 degrees of freedom, rad (see Dof for zero and sign).
struct Posture {
  std::array<double, kDofCount> angle{};

  double& operator[](Dof dof) { return angle[static_cast<std::size_t>(dof)]; }
  double operator[](Dof dof) const { return angle[static_cast<std::size_t>(dof)]; }
};

}  // namespace palmar
