// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::geometry {

struct WeldOptions {
  double tolerance = 0.0;             ///< mm; vertices this near become one; 0: only equal ones
  bool drops_duplicates = true;       ///< keep one of the triangles with the same three vertices
  bool drops_unused_vertices = true;  ///< forget vertices that no triangle uses
  /// Per triangle: vertices of different groups stay apart, however near; empty: all are one.
  std::vector<int> groups = {};
  void check() const;  ///< throws UsageError: field, value, allowed range
};

struct WeldResult {
  TriangleMesh mesh;
  std::vector<int> new_of_old;           ///< per vertex of the input; -1 for a dropped one
  std::vector<int> old_of_new;           ///< smallest input vertex behind each vertex of the result
  std::vector<int> old_triangle_of_new;  ///< per triangle of the result: that of the input
  int merged_vertices = 0;
  int dropped_degenerate = 0;  ///< triangles that use a vertex twice after merging
  int dropped_duplicate = 0;   ///< triangles with the three vertices of an earlier one
  int dropped_unused = 0;      ///< vertices
};

/// Merges vertices closer than the tolerance, drops triangles that collapse by it. In the order of
/// the input, each vertex joins the first kept vertex within the tolerance (and takes its place),
/// else is kept; so chains don't run together, kept vertices are farther apart than the tolerance,
/// and a vertex moves by at most the tolerance. Order of vertices and triangles stays. Throws
/// InputError on a coordinate that is not finite, a corner outside the vertex list, or groups of
/// another number of triangles.
WeldResult weld(const TriangleMesh& mesh, const WeldOptions& options = {});

}  // namespace palmar::geometry
