// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hands/capture/mri/scan_surfaces.h"
#include "hands/imaging/volume.h"
#include "palmar/core/progress.h"
#include "palmar/hand/hand.h"

namespace palmar::capture {

/// Finds skin, bones and markers in a T1-weighted MR image of one hand. `model`: any hand, for
/// names: which bones there are and how they follow each other. See docs/method/mri.md.
/// Throws InputError, naming `name` (the series): no hand, two hands, an image too coarse.
ScanSurfaces find_surfaces(const imaging::Volume& image, const std::string& name,
                           const hand::Hand& model, const SurfaceOptions& options = {},
                           const Progress& progress = {});

}  // namespace palmar::capture
