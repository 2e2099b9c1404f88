// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::geometry {

// Level lines of a field that has one value per vertex and is linear on every triangle. A vertex is
// inside if its value is at or above the level. Vertices on borders, on edges of more than two
// triangles and where neighbours disagree about outside count as outside, so that every line is
// closed. All functions throw UsageError if the field doesn't have one value per vertex.

/// A closed line on the mesh; seen from outside of the surface, the inside is on its left.
struct IsoLoop {
  std::vector<Vec3> points;  ///< one per edge crossed, mm; the first isn't repeated
  int inside_vertex = -1;    ///< next to its first point
};

/// Lines on which the field has the value `level`, in the order of their smallest edge.
std::vector<IsoLoop> iso_loops(const TriangleMesh& mesh, std::span<const double> field,
                               double level);

/// Area of each triangle where the field is at or above the level, mm^2.
std::vector<double> areas_above(const TriangleMesh& mesh, std::span<const double> field,
                                double level);

/// The two sides of a level, cut into what hangs together along edges.
struct IsoParts {
  std::vector<int> of_vertex;   ///< part of each vertex
  std::vector<char> is_inside;  ///< per part
  std::vector<double> area;     ///< mm^2, per part; of an outside part its share of the triangles
};
IsoParts iso_parts(const TriangleMesh& mesh, std::span<const double> field, double level);

}  // namespace palmar::geometry
