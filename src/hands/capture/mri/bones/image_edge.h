// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "hands/capture/mri/scan_surfaces.h"
#include "hands/imaging/volume.h"

namespace palmar::capture {

/// Sets is_cut of the bones in whose finger the skin ends at the edge of the image, though the bone
/// itself may not: those nearest to skin within a voxel of the outermost voxel centres.
void mark_cut_fingers(ScanSurfaces& surfaces, const imaging::VolumeGrid& grid);

/// Names of the phalanges and metacarpals that the image cuts. Radius and ulna always are.
std::vector<std::string> cut_bones_of_fingers(const ScanSurfaces& surfaces);

}  // namespace palmar::capture
