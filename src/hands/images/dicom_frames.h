// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "hands/images/dicom_elements.h"
#include "hands/images/dicom_slice.h"

namespace palmar::images {

/// The slices of a file, one for each frame, from what `whole` says of all of them. What is wrong
/// goes into `damage`.
///
/// Where a frame lies comes from, in this order:
///
/// 1. functional groups (enhanced MR), what a frame says of itself before what is said of all;
/// 2. Grid Frame Offset Vector: distances from Image Position along the slices' normal (which is
///    row x column), or, for transversal slices, their z;
/// 3. Spacing Between Slices: frames that follow each other along the normal. The standard doesn't
///    say on which side; `has_assumed_order` is set.
///
/// Source: DICOM PS3.3 (2023), C.7.6.16 (functional groups), C.8.8.3.2 (Grid Frame Offset Vector).
std::vector<DicomSlice> frames_of(const DicomElements& elements, const DicomSlice& whole);

}  // namespace palmar::images
