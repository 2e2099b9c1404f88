// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/geometry/types.h"
#include "palmar/imaging/volume.h"

namespace palmar {

/// A closed surface and the T1-weighted signal of what it encloses. Later parts cover earlier ones
/// (skin, fat, muscle, cortical bone, marrow, marker).
struct ImagedPart {
  TriangleMesh mesh;    ///< closed, oriented outwards; patient frame, mm
  double signal = 0.0;  ///< of the tissue; air 0, marrow and fat about 200
};

struct ScannerOptions {
  int subsamples = 3;  ///< per voxel edge at surfaces: partial volume
  double snr = 25.0;  ///< mean signal of the brightest part over the noise's deviation; 0: no noise
  double bias = 0.25;      ///< the receive field falls by this share across the image; 0: none
  std::uint64_t seed = 1;  ///< of noise and field
  void check() const;      ///< throws UsageError: field, value, allowed range
};

/// The image that an ideal scanner makes of the parts: partial volume by subsampling, a smooth
/// multiplicative field, Rician noise (Gudbjartsson, Patz 1995). Deterministic, whatever the number
/// of threads. Throws UsageError, Cancelled; InputError for a part that is not closed.
Volume image_of(const std::vector<ImagedPart>& parts, const VolumeGrid& grid,
                const ScannerOptions& options = {}, const Progress& progress = {});

}  // namespace palmar
