// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/contact/bone/patch_matrix.h"
#include "palmar/geometry/tetra/tetrahedral_mesh.h"

namespace palmar::contact {

/// A unit force on a body's surface, as forces [N] on vertices of its mesh.
struct SurfaceLoad {
  std::vector<int> vertex;  ///< ascending
  std::vector<Vec3> force;
};

struct SurfaceComplianceOptions {
  double poisson = 0.5;
  /// What of a load passes on to later vertices is left out below this share of a newton. The
  /// compliance is wrong by about as large a share.
  double pruning = 1e-4;
  void check() const;  ///< throws UsageError
};

/// How far a load moves the body at another, along that one's forces, times the body's shear
/// modulus, 1/mm:
///
///     C_ij = f_i . K^-1 f_j
///
/// into `compliance`, whose rows are the loads; pairs of patches without a block aren't formed.
/// The body, elastic and of one shear modulus, is held where `is_held` (per vertex of the mesh).
///
/// K is the quasi-definite matrix of the mini elements (mini_element.h), eliminated along a nested
/// dissection, front by front with dense blocks (Duff, Reid 1983). The loads travel along as a
/// border of the fronts in which they act: what elimination leaves on it is -C, so that no system
/// is solved for any single load. Returns the largest memory of fronts, bytes.
///
/// Throws NumericalError if a front isn't definite: a part of the body isn't held anywhere.
std::size_t surface_compliance(const geometry::TetrahedralMesh& mesh,
                               const std::vector<char>& is_held,
                               const std::vector<SurfaceLoad>& loads,
                               const SurfaceComplianceOptions& options, PatchMatrix& compliance);

}  // namespace palmar::contact
