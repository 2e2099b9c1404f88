// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/geometry/types.h"

namespace palmar::geometry {

/// A coarser mesh: vertices in one cube of a grid of `spacing` [mm] become one at their mean, and
/// triangles that collapse go. For looking things up (nearest points, normals), where a tenth of
/// the triangles will do: it may touch itself and have edges with more than two triangles. A
/// surface of curvature radius r moves inwards by spacing^2 / (24 r) or so. Throws UsageError
/// unless spacing > 0.
///
/// Source: Rossignac, Borrel 1993.
TriangleMesh cluster_vertices(const TriangleMesh& mesh, double spacing);

}  // namespace palmar::geometry
