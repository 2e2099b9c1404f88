// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/geometry/mesh/textured_mesh.h"

namespace palmar::phantom {

/// A cardboard box of these edges (x, y, z, mm), its middle at the origin; corners of its faces are
/// apart, so that each face has its own normals. Throws UsageError unless edges are 5 to 200 mm.
geometry::ColouredMesh make_block(const Vec3& edges);

}  // namespace palmar::phantom
