// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace palmar::geometry {

/// 0 up to t = 0, 1 from t = 1 on, 3 t^2 - 2 t^3 in between: no kink at either end.
inline double smooth_step(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace palmar::geometry
