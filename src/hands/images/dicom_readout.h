// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hands/images/dicom_elements.h"
#include "hands/images/dicom_slice.h"

namespace palmar::images {

/// By how much fat's protons precess more slowly than water's.
inline constexpr double kFatBelowWater = 3.35e-6;  // of the frequency

/// How far a slice shows fat off water, along the read-out in the patient frame, mm:
///
///     shift = 3.35e-6 f / b    acquired pixels,
///
/// with f the Imaging Frequency (0018,0084; Transmitter Frequency (0018,9098) of multi-frame files)
/// and b the Pixel Bandwidth (0018,0095). The read-out runs across In-plane Phase Encoding
/// Direction (0018,1312); an acquired pixel is the field of view over the number of samples in
/// Acquisition Matrix (0018,1310), or a pixel where that isn't given. Its sign isn't in the file.
/// Zero where something is missing or no such number of a scanner. `slice`: size and axes of its
/// plane. Source: Brown et al. 2014, Magnetic Resonance Imaging, 2nd ed., chapter 17 (3.35 ppm).
Vec3 fat_shift_of(const DicomAttributes& attributes, const DicomSlice& slice);

}  // namespace palmar::images
