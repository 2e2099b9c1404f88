// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hands/capture/photo/surface/point_cells.h"
#include "palmar/geometry/types.h"

namespace palmar::capture {

/// Undoes what flat patches do to a curved surface. A plane that is fitted to a patch lies at the
/// mean depth of what the patch covers, which on convex skin is behind its middle: with K the
/// curvature of the surface [1/mm, symmetric in the tangent plane, positive where convex] and S the
/// covariance of the places that patches cover [mm^2], by
///
///     d = 1/2 tr(K S),
///
/// half a square patch's variance over the radius on a cylinder seen frontally, twice that on a
/// ball. Every vertex moves out by its d [mm]: K from the least-squares paraboloid through the
/// vertices within 3 mm over the mesh, S from the points of the nearest cells. Vertices that no
/// points are near to stay; no vertex moves more than 0.6 mm (edges sharper than patches can show).
/// The mesh: manifold, oriented outwards, edges well below 3 mm.
geometry::TriangleMesh without_flat_patches(const geometry::TriangleMesh& mesh,
                                            const PointCells& points);

}  // namespace palmar::capture
