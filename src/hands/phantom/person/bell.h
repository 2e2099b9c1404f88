// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace palmar::phantom {

/// exp(-distance^2 / (2 width^2)).
inline double bell(double distance, double width) {
  return std::exp(-0.5 * distance * distance / (width * width));
}

}  // namespace palmar::phantom
