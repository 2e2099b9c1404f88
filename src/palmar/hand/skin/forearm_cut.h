// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/geometry/types.h"

namespace palmar::hand {

/// Makes the cut through the forearm plane and even: the rim moves along y onto the plane that fits
/// it best, and the triangles that close it (hand frame: facing proximally, proximal of the wrist
/// joint) give way to rings and a middle, so that a subdivided rim is round all about.
///
/// A skin without such a cut, or with more than one, comes back as it is.
geometry::TriangleMesh with_even_cut(const geometry::TriangleMesh& skin_in_hand);

}  // namespace palmar::hand
