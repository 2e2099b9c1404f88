// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::geometry {

struct SeparatedSheets {
  TriangleMesh mesh;          ///< same triangles in the same order; new vertices at the end
  std::vector<Vec3> doubled;  ///< corners that became two, mm
  std::vector<Vec3>
      separated_edges;           ///< middles of edges of more than two triangles that are no more
  std::vector<Vec3> left_edges;  ///< middles of those that stay
};

/// Takes apart what touches: where solids meet in an edge (four triangles and more at it) or in a
/// corner only, the corner is doubled and the smaller share of the triangles takes the copy, `gap`
/// [mm] inside of its own surface, so that welding doesn't join them again.
///
/// An edge is separated only if its triangles alternate round it between faces that have their
/// material after and before them, each pair bounding one wedge of material; others (a wall within
/// a solid, a fin, neighbours that disagree about outside) stay. Corners at which the surface is
/// open stay. The mesh should be oriented (orient.h) and its vertices finite. Throws InputError on
/// a corner outside the list.
SeparatedSheets separate_touching_sheets(const TriangleMesh& mesh, double gap);

}  // namespace palmar::geometry
