// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "palmar/core/random.h"

namespace palmar::phantom {

/// Normal about 0 with the deviation, held to two and a half of it.
inline double spread(RandomStream& random, double deviation) {
  return deviation * std::clamp(random.normal(), -2.5, 2.5);
}

/// Even between plus and minus `most`.
inline double about_zero(RandomStream& random, double most) {
  return most * (2.0 * random.uniform() - 1.0);
}

}  // namespace palmar::phantom
