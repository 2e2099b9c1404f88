// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "palmar/core/random.h"
#include "palmar/geometry/types.h"

namespace palmar::phantom {

/// Normal about 0 with the deviation, held to two and a half of it.
inline double spread(RandomStream& random, double deviation) {
  return deviation * std::clamp(random.normal(), -2.5, 2.5);
}

/// Three independent numbers of one kind. Compilers differ in the order in which they evaluate the
/// arguments of a call; here z is drawn first, so that a seed gives the same person everywhere.
inline Vec3 normal_vector(RandomStream& random) {
  const double z = random.normal(), y = random.normal(), x = random.normal();
  return {x, y, z};
}
inline Vec3 spread_vector(RandomStream& random, double deviation) {
  const double z = spread(random, deviation), y = spread(random, deviation);
  return {spread(random, deviation), y, z};
}

/// Even between plus and minus `most`.
inline double about_zero(RandomStream& random, double most) {
  return most * (2.0 * random.uniform() - 1.0);
}

}  // namespace palmar::phantom
