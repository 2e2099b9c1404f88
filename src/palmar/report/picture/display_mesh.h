// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/report/picture/image.h"

namespace palmar::report {

/// A mesh to look at, with a value per vertex.
struct DisplayMesh {
  geometry::TriangleMesh mesh;  ///< mm
  std::vector<double> value;    ///< one per vertex
};

/// The mesh with at most `most_triangles` triangles: vertices that fall into one cell of a grid are
/// joined at their mean and keep their largest value, triangles that shrink to nothing are dropped;
/// the grid is coarsened until it is enough (vertex clustering; Rossignac and Borrel 1993). A mesh
/// that is small enough comes back as it is. For display only: not for computing.
DisplayMesh display_mesh(const geometry::TriangleMesh& mesh, const std::vector<double>& value,
                         int most_triangles);

/// A point or a colour as the viewers' JSON has it: "[1,2.5,3]", each number in full.
std::string json_triple(const Vec3& point);
std::string json_triple(Rgb colour);

}  // namespace palmar::report
