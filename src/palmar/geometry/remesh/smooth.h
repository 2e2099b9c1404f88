// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/geometry/types.h"

namespace palmar::geometry {

struct TaubinOptions {
  int rounds = 10;         ///< pairs of steps, 0 to 10000
  double lambda = 0.5;     ///< forward step, (0, 1)
  double pass_band = 0.1;  ///< k_PB: waves below it stay; (0, 1). mu = 1 / (k_PB - 1 / lambda)
  void check() const;      ///< throws UsageError: field, value, allowed range
};

/// Takes out noise of a few edges' length without shrinking the shape. Each round moves every inner
/// vertex v by lambda L(v) and then by mu L(v) with mu < -lambda, where L(v) is the mean of the
/// neighbours minus v. A wave of frequency k (an eigenvalue of -L, 0 to 2) is multiplied by
/// (1 - lambda k)(1 - mu k): about 1 below k_PB, less above. Border vertices follow their border
/// alone. Adjacency stays. Vertices without triangles stay.
///
/// Source: Taubin 1995, "A signal processing approach to fair surface design".
TriangleMesh smooth_taubin(const TriangleMesh& mesh, const TaubinOptions& options = {});

struct TangentialOptions {
  int rounds = 5;      ///< 0 to 10000
  double step = 0.5;   ///< share of the way to the mean of the neighbours, (0, 1]
  void check() const;  ///< throws UsageError: field, value, allowed range
};

/// Evens out triangles and keeps the shape: inner vertices move towards the mean of their
/// neighbours, but only in their tangent plane (area-weighted normal), so that the surface changes
/// in second order of the step alone. Border vertices stay.
TriangleMesh smooth_tangentially(const TriangleMesh& mesh, const TangentialOptions& options = {});

}  // namespace palmar::geometry
