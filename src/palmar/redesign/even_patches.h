// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::redesign {

/// Triangles of a mesh made anew, nearly equilateral, edges up to `edge_length` [mm] (5 % more at
/// most, by trying): those whose entry in `group` is 0 or more. Edges between triangles of
/// different groups, and those that turn by more than 40 degrees, stay as they are, so they must
/// not be longer either; triangles of group -1 and their vertices stay. Where patches between such
/// edges aren't 2-manifold, they stay, too.
geometry::TriangleMesh with_even_patches(const geometry::TriangleMesh& mesh,
                                         const std::vector<int>& group, double edge_length);

}  // namespace palmar::redesign
