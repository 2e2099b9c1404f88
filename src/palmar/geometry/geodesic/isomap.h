// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>

#include "palmar/geometry/types.h"

namespace palmar::geometry {

/// A patch of skin flattened.
struct FlatPatch {
  Eigen::MatrixX2d position;  ///< mm; one row per point, about their mean, long direction first
  /// Share of the distances that the flat picture doesn't explain: 1 - R^2, R the correlation
  /// between given and flat distances over all pairs. 0 for a developable patch.
  double residual_variance = 0.0;
};

/// Isometric mapping: points in the plane whose straight distances are, as nearly as a linear
/// method can, the given distances D [mm] along the surface. Classical scaling of
///
///     B = -1/2 J D2 J,   D2_ij = D_ij^2,   J = 1 - 1 1^T / n,
///
/// B v_k = lambda_k v_k: coordinate k of point i is sqrt(lambda_k) v_ik, for the two largest
/// eigenvalues (subspace iteration; about 0.02 s for 600 points). A direction whose eigenvalue is
/// not positive gives 0. The sign of a coordinate is such that the first of its largest entries is
/// positive, so the same distances give the same bytes.
///
/// `distance` is n x n, n >= 1, symmetric with a zero diagonal: UsageError naming the entry, also
/// for an infinite one (a patch in pieces has no flat picture).
///
/// Source: Tenenbaum, de Silva, Langford 2000, Science 290, 2319 (steps 2 and 3, note 43 for the
/// residual); Torgerson 1952 (classical scaling). Used by Xie 2014, section 3.3 (A2).
FlatPatch flatten_by_isomap(const Eigen::MatrixXd& distance);

/// Lengths [mm] of shortest paths along the edges of the triangles whose corners all are in
/// `vertices` (no vertex twice): Isomap's own graph distances, with the mesh's edges as the
/// neighbourhood graph. Row and column k stand for vertices[k]. They are too long, by up to 15 % on
/// a lattice of equilateral triangles; GeodesicSolver's cross triangles. Throws UsageError naming
/// two vertices between which there is no path, a vertex that is outside the mesh or given twice.
///
/// Source: Dijkstra 1959.
Eigen::MatrixXd edge_path_distances(const TriangleMesh& mesh, std::span<const int> vertices);

}  // namespace palmar::geometry
