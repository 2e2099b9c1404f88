// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/capture/mri/scan_surfaces.h"

namespace palmar {

/// A name that the user gives to the bone at a point.
struct BoneLabel {
  std::string name;           ///< as Hand::bones has it
  Vec3 point = Vec3::Zero();  ///< in or near the bone; patient frame, mm
  std::string place;          ///< "labels.csv, line 3", for messages
};

/// Names the bone that holds each label's point, or the nearest one within 3 mm; a bone that had
/// that name before, and isn't labelled itself, loses it. Throws InputError naming the label's
/// place for: a name that no bone of `model` has (with the nearest one), a name twice, no bone near
/// the point, two labels on one bone.
void apply_bone_labels(ScanSurfaces& surfaces, const std::vector<BoneLabel>& labels,
                       const Hand& model);

}  // namespace palmar
