// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/geometry/types.h"

namespace palmar::geometry {

enum class SubdivisionScheme {
  kLoop,          ///< Loop's scheme: smoothest, but shrinks (a coarse hand by 3 % of its volume)
  kFittedLoop,    ///< Loop's scheme on a control mesh moved so that the limit meets the vertices;
                  ///< holds more than the given mesh (the same hand: 3 %)
  kLoopOfVolume,  ///< between the two, so that the volume is kept; closed meshes only
};

struct SubdivisionOptions {
  SubdivisionScheme scheme = SubdivisionScheme::kLoopOfVolume;
  int levels = 1;  ///< 0 to 6; each makes four triangles of one
  /// Rounds of the fit (not used by kLoop). Each moves every control vertex by what its limit point
  /// misses of the given vertex. Long waves converge at once, single-vertex noise late; so one
  /// round brings back size and most of the length of fingertips without the noise of the input.
  int fit_rounds = 1;
  /// Finally vertices are put on the limit surface of the scheme.
  bool projects_to_limit = true;
  void check() const;  ///< throws UsageError: field, value, allowed range
};

/// Smooth subdivision surface of a mesh with `levels` times refined triangles. A border (edges with
/// one triangle) becomes a cubic B-spline curve that doesn't depend on the inside; edges with more
/// than two triangles are treated like borders. The first vertices of the result are those of the
/// input, in order. Weights:
///   inner vertex of n neighbours: (1 - n b) v + b * sum,  b = 3/16 for n = 3, else 3 / (8 n)
///   inner edge: 3/8 (a + b) + 1/8 (c + d);  border: 1/8, 3/4, 1/8 and 1/2, 1/2
///   limit: (1 - n g) v + g * sum,  g = 1 / (n + 3 / (8 b));  border: 1/6, 2/3, 1/6
/// Smooth (C2) except at irregular vertices (C1). kLoopOfVolume moves the control vertices by a
/// share of the fit, 0 to 1, such that the signed volume of the result is that of the input (to
/// 1e-6 if a share does so, else the nearer end). Throws InputError on a corner outside the vertex
/// list and, for kLoopOfVolume, on a mesh that isn't closed.
///
/// Source: Loop 1987, with the weights of Warren 1995 for b; Hoppe et al. 1994 for borders and
/// limits; Cheng et al. 2009, "Loop subdivision surface based progressive interpolation", for the
/// fit.
TriangleMesh subdivide(const TriangleMesh& mesh, const SubdivisionOptions& options = {});

}  // namespace palmar::geometry
