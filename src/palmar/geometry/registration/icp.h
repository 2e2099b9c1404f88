// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/core/progress.h"
#include "palmar/geometry/rigid3.h"
#include "palmar/geometry/types.h"

namespace palmar::geometry {

struct IcpOptions {
  double trim = 0.2;         ///< share of the worst pairs left out of each step, [0, 0.9]
  int max_iterations = 60;   ///< of the last, full search
  double tolerance = 1e-4;   ///< mm; a step that moves no point farther ends the search
  int samples = 1500;        ///< points of the moving surface, spread evenly over its area
  double start_turn = 1.05;  ///< rad, [0, pi]; starts turned by this are tried, too (0: none)
  void check() const;        ///< throws UsageError: field, value, allowed range
};

/// How a surface was placed on another one.
struct IcpResult {
  Rigid3 fixed_from_moving;
  double mean = 0.0;         ///< distance of all samples to the fixed surface, mm
  double trimmed_rms = 0.0;  ///< of the pairs that count, mm
  double overlap = 0.0;      ///< share of samples within three times trimmed_rms
  /// Smallest eigenvalue of the normal equations over the largest: how well the shape holds the
  /// motion; a surface of revolution gives 0 about its axis.
  double conditioning = 0.0;
  int iterations = 0;  ///< of the best start
  bool has_converged = false;
};

/// Rigid registration of a surface to another by trimmed iterative closest points, point to plane
/// (Chen, Medioni 1992; trimmed as in Chetverikov et al. 2002), started from `start` and from turns
/// of it about the middle of the moving surface, there and where the fixed surface has its own.
///
/// Both surfaces oriented outwards; parts of either may be missing. Partners' normals must agree
/// within 60 degrees, and a partner on the rim of an open fixed surface doesn't count (Turk, Levoy
/// 1994); far pairs lose weight (Geman, McClure 1985). A surface turned inside out has no partners:
/// overlap 0, not converged. Deterministic. Throws UsageError, InputError for a surface without
/// area, Cancelled.
IcpResult register_rigidly(const TriangleMesh& moving, const TriangleMesh& fixed,
                           const Rigid3& start = {}, const IcpOptions& options = {},
                           const Progress& progress = {});

}  // namespace palmar::geometry
