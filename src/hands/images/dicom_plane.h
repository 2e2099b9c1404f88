// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hands/images/dicom_elements.h"
#include "hands/images/dicom_slice.h"

namespace palmar::images {

/// Reads Image Orientation, Image Position and Pixel Spacing, those of a file or of a frame;
/// returns why they can't be used, with tag, value and what is allowed, or "".
///
/// Source: DICOM PS3.3 (2023), C.7.6.2 (image plane).
std::string read_plane(const DicomAttributes& attributes, DicomSlice& slice);

/// The same for Rescale Slope and Intercept.
std::string read_rescaling(const DicomAttributes& attributes, DicomSlice& slice);

}  // namespace palmar::images
