// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "palmar/core/enum_index.h"
#include "palmar/hand/anatomy.h"

namespace palmar::hand {

/// Angles of the 23 degrees of freedom, rad (see Dof for zero and sign).
struct Posture {
  std::array<double, kDofCount> angle{};

  double& operator[](Dof dof) { return angle[index_of(dof)]; }
  double operator[](Dof dof) const { return angle[index_of(dof)]; }
};

}  // namespace palmar::hand
