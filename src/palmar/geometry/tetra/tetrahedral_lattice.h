// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "palmar/geometry/tetra/tetrahedral_mesh.h"

namespace palmar::geometry {

/// A cube of the lattice.
struct LatticeCube {
  Vec3 centre = Vec3::Zero();
  double edge = 0.0;  ///< mm
};

struct LatticeOptions {
  double edge = 4.0;  ///< of the largest cubes, mm
  int levels = 1;     ///< sizes of cubes, each half the one before; 1 to 6
  /// Whether a cube (not of the last level) is split into eight. None: no cube is.
  std::function<bool(const LatticeCube&)> is_split = {};
  /// Whether a cube's part of the lattice is needed. None: all are.
  std::function<bool(const LatticeCube&)> is_wanted = {};
  void check() const;  ///< throws UsageError: field, value, allowed range
};

/// Body-centred cubic lattice over (at least) a box: vertices in the corners and middles of cubes,
/// four tetrahedra over every face between two cubes of one size (edges of 1 and 0.87 cube edges,
/// dihedral angles of 60 and 90 degrees). Cubes that touch differ by a factor of two at most; over
/// a face between two sizes stand pyramids, and tetrahedra along an edge that is split elsewhere
/// are split with it, so that all faces agree (Labelle, Shewchuk 2007, section 3). Faces without a
/// wanted cube on both sides have no tetrahedra.
TetrahedralMesh make_tetrahedral_lattice(const Box3& box, const LatticeOptions& options);

}  // namespace palmar::geometry
