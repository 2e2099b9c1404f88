// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/geometry/types.h"

namespace palmar {

enum class SubdivisionScheme {
  kLoop,       ///< Loop's scheme: very smooth, shrinks (the hand by 2.3 % of its volume)
  kFittedLoop  ///< Loop's scheme on a control mesh moved so that the limit keeps the vertices
};

struct SubdivisionOptions {
  SubdivisionScheme scheme = SubdivisionScheme::kFittedLoop;
  int levels = 1;  ///< 0 to 6; each makes four triangles of one
  /// Rounds of the fit (kFittedLoop). Round k moves each control vertex by what its limit point
  /// misses of the given vertex. Long waves converge at once, single-vertex noise late; so a few
  /// rounds restore the volume without pulling the noise of the input into the smooth surface.
  int fit_rounds = 3;
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
/// Smooth (C2) except at irregular vertices (C1). Throws InputError on a corner outside the vertex
/// list.
///
/// Source: Loop 1987, with the weights of Warren 1995 for b; Hoppe et al. 1994 for borders and
/// limits; Cheng et al. 2009, "Loop subdivision surface based progressive interpolation", for the
/// fit.
TriangleMesh subdivide(const TriangleMesh& mesh, const SubdivisionOptions& options = {});

}  // namespace palmar
