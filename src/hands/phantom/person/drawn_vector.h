// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/core/random.h"
#include "palmar/geometry/types.h"

namespace palmar::phantom {

/// Three independent standard normal numbers. Compilers differ in the order in which they evaluate
/// the arguments of one call; here z is drawn first, so that a seed gives the same person
/// everywhere.
inline Vec3 normal_vector(RandomStream& random) {
  const double z = random.normal(), y = random.normal(), x = random.normal();
  return {x, y, z};
}

}  // namespace palmar::phantom
