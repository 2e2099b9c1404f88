// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/types.h"
#include "palmar/product/parts/rough_parts.h"
#include "palmar/product/parts/solid_grid.h"

namespace palmar::product {

/// Which part each triangle of a product belongs to: that of the nearest ball.
std::vector<int> labels_of(const geometry::TriangleMesh& mesh, const SolidGrid& grid,
                           const RoughParts& rough);

/// Pieces of a part apart from its largest take the part that they border on most, if they are
/// small: specks where two parts are equally near.
void absorb_islands(const geometry::TriangleMesh& mesh, const geometry::MeshTopology& topology,
                    std::vector<int>& label);

/// Triangles of a bar beyond its joined ends belong to what it joins there. `line` is the bar's
/// centre line, `id` its label.
void give_to_joined(const geometry::TriangleMesh& mesh, const RoughPart& rough,
                    const std::vector<Vec3>& line, int id, std::vector<int>& label);

/// The triangles with a label, as a mesh of their own.
geometry::TriangleMesh piece_of(const geometry::TriangleMesh& mesh, const std::vector<int>& label,
                                int part);

}  // namespace palmar::product
