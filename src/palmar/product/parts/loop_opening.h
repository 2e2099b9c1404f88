// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/product/parts/product_parts.h"

namespace palmar::product {

/// The opening that a loop's centre line goes round (an open line is closed by a straight one), in
/// the plane of the line: its mean plane by the area vector 1/2 sum p_i x p_i+1. The outline of the
/// opening is what the solid encloses in a section by this plane; where solids only overlap, the
/// air between them, to half a millimetre. Nothing if the plane meets no closed ring there.
std::optional<PartOpening> loop_opening(const geometry::TriangleMesh& mesh,
                                        const std::vector<Vec3>& line);

}  // namespace palmar::product
