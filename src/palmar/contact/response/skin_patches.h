// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/contact/response/skin_geometry.h"

namespace palmar::contact {

/// Partition of a skin into patches of neighbouring vertices: blocks of a preconditioner, clusters,
/// spots for coarse questions. `patch` per vertex; patches are numbered from 0 in the order of
/// their lowest vertex.
struct SkinPatches {
  std::vector<int> patch;
  int count = 0;
};

/// Patches of up to `size` vertices, grown over edges from the lowest vertex that is left.
SkinPatches skin_patches(const SkinGeometry& skin, int size);

/// Mean position of the vertices of each patch, mm.
std::vector<Vec3> patch_centres(const SkinGeometry& skin, const SkinPatches& patches);

}  // namespace palmar::contact
