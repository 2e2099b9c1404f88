// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/product/intake/unit_guard.h"
#include "palmar/product/product.h"

namespace palmar::product {

/// Makes a product of a mesh as it stands in a file: converts to mm, welds vertices nearer than a
/// millionth of the size, drops triangles that collapse by it, repairs the orientation of patches
/// (orient.h) and prepares the signed distance (mesh_distance.h). What was done, and what is left
/// doubtful (holes, for one), is reported in notes, the unit's explanation first.
///
/// `raw` is in the unit of `unit`; `source` is the path or the command that made it and stands in
/// front of every message. Throws InputError on no triangles, on one triangle, on vertices that are
/// not finite (naming the vertex), on corners outside the vertex list, and if nothing with an area
/// is left. `faces` (of a CAD model; null: none) are those of `raw`, triangle by triangle and in
/// its unit; they follow the mesh. Throws InputError if they don't fit it (check_faces()).
Product make_product(const std::string& name, const geometry::TriangleMesh& raw,
                     const UnitDecision& unit, const std::string& source,
                     const ProductFaces* faces = nullptr);

}  // namespace palmar::product
