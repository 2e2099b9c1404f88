// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/geometry/tetra/tetrahedral_mesh.h"

namespace palmar::contact {

/// A part of a nested dissection: the vertices that are eliminated together, after those of both
/// children, and those that they act on, which are eliminated later.
struct DissectionNode {
  std::vector<int> vertex;   ///< eliminated here
  std::vector<int> later;    ///< ascending by order of elimination
  std::vector<int> element;  ///< tetrahedra to be assembled here
  std::vector<int> child;    ///< at most two
};

/// Nested dissection of a mesh: two parts by a plane across the axis and at the share that need the
/// fewest vertices of one part to separate it from the other, and so on down to `leaf` vertices
/// (George 1973).
/// Children stand before their parents; the last node is the root.
std::vector<DissectionNode> dissect(const geometry::TetrahedralMesh& mesh, int leaf = 64);

}  // namespace palmar::contact
