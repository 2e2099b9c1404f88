// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "hands/capture/mri/scan_surfaces.h"
#include "palmar/hand/person/person_labels.h"

namespace palmar::capture {

/// Names the bone that holds each label's point, or the nearest one within 3 mm; a bone that had
/// that name before, and isn't labelled itself, loses it. Throws InputError naming the label's
/// place for: a name that no bone of `model` has (with the nearest one), a name twice, no bone near
/// the point, two labels on one bone.
void apply_bone_labels(ScanSurfaces& surfaces, const std::vector<hand::BoneLabel>& labels,
                       const hand::Hand& model);

}  // namespace palmar::capture
