// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::geometry {

/// What is left of a closed mesh on one side of a plane: an open mesh and the loops of its rim.
struct CutMesh {
  TriangleMesh mesh;                  ///< triangles keep their order and their outside
  std::vector<int> triangle_of;       ///< per triangle: the one it is (a part) of
  std::vector<std::vector<int>> rim;  ///< vertex loops in the plane, each as its triangles run
};

/// Keeps the side of the plane through `point` that its unit normal `normal` points to. Vertices
/// nearer to the plane than `snap` [mm] are moved onto it first, so that no slivers arise; with 0
/// nothing moves. A mesh wholly on one side comes back whole or empty, without rim.
///
/// Throws UsageError if the normal is not of unit length or snap is negative; InputError if a rim
/// touches itself, which a closed 2-manifold mesh does only when the plane grazes it: shift the
/// plane a little.
CutMesh cut_by_plane(const TriangleMesh& closed, const Vec3& point, const Vec3& normal,
                     double snap = 0.0);

}  // namespace palmar::geometry
