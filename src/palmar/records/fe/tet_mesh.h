// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/hand/tissue_block.h"

namespace palmar::records {

/// Second-order tetrahedra with straight edges; mm. Corners 0 to 3 (corner 3 on the side to which
/// the normal of 0, 1, 2 points), then the middles of edges 0-1, 1-2, 2-0, 0-3, 1-3, 2-3: the
/// order of C3D10.
struct TetMesh {
  std::vector<Vec3> nodes;
  std::vector<std::array<int, 10>> tets;
};

/// Side of a tetrahedron as CalculiX counts them: 1 is corners 0, 1, 2; 2 is 0, 3, 1; 3 is 1, 3, 2;
/// 4 is 2, 3, 0.
struct TetSide {
  int tet = 0;
  int side = 1;
};

/// A boundary triangle with the mark of the facet it lies on.
struct MarkedFace {
  Triangle corner{};
  int mark = 0;
};

/// Mesh of a tissue block: sides on the skin that is pressed, corners and middles that are held.
struct BlockMesh {
  TetMesh mesh;
  std::vector<TetSide> pressed;  ///< BlockFace::kRegion, ascending
  std::vector<int> on_bone;      ///< nodes, ascending
  std::vector<int> on_cut;       ///< nodes that are not on bone, ascending
};

/// Adds the middles to first-order tetrahedra, turns those that are inside out, and sorts the
/// boundary. Throws InputError on a flat tetrahedron or an index out of range.
BlockMesh make_block_mesh(const std::vector<Vec3>& nodes,
                          const std::vector<std::array<int, 4>>& tets,
                          const std::vector<MarkedFace>& faces);

/// Six times the volume of the smallest tetrahedron, mm^3: the Jacobian, constant for straight
/// edges. Negative if one is inside out.
double smallest_jacobian(const TetMesh& mesh);

/// Volume, mm^3.
double volume(const TetMesh& mesh);

/// A tissue block as input of TetGen (.poly, format of TetGen 1.5, section 5.2.2); the mark of a
/// facet is its BlockFace.
std::string tetgen_poly(const hand::TissueBlock& block);

/// TetGen's .node, .ele and .face files (first order) as a mesh. `name` is for messages. Throws
/// InputError naming file and line.
BlockMesh read_tetgen(const std::string& stem);

}  // namespace palmar::records
