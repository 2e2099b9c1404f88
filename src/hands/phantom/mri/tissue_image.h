// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "hands/imaging/volume.h"
#include "palmar/core/progress.h"
#include "palmar/geometry/types.h"

namespace palmar::phantom {

/// What decides where and how evenly a tissue shows: fat lies off by the chemical shift; marrow is
/// fat in a mesh of bone.
enum class ImagedTissue : std::uint8_t { kWater, kFat, kMarrow };

/// A closed surface and the T1-weighted signal of what it encloses. Later parts cover earlier ones
/// (skin, fat, muscle, cortical bone, marrow, marker).
struct ImagedPart {
  geometry::TriangleMesh mesh;  ///< closed, oriented outwards; patient frame, mm
  double signal = 0.0;          ///< of the tissue; air 0, marrow and fat about 200
  ImagedTissue tissue = ImagedTissue::kWater;
};

struct ScannerOptions {
  int subsamples = 3;  ///< per voxel edge at surfaces: partial volume
  double snr = 25.0;  ///< mean signal of the brightest part over the noise's deviation; 0: no noise
  double bias = 0.25;      ///< the receive field falls by this share across the image; 0: none;
                           ///< surface coils: 0.5 to 0.8
  double fat_shift = 0.0;  ///< of fat and marrow along the rows (i, the read-out), mm
  /// Share of the resolution along rows and columns that is acquired, the rest filled with zeros:
  /// edges ring by 9 % of their height (Gibbs). 1: no ringing.
  double acquired = 1.0;
  double marrow_texture = 0.0;  ///< relative deviation of marrow's signal, waves of 2.5 mm
  double mask =
      0.0;  ///< signals below this many deviations of the noise become 0: a masked background
  std::uint64_t seed = 1;  ///< of noise and field
  void check() const;      ///< throws UsageError: field, value, allowed range
};

/// The image that an ideal scanner makes of the parts: partial volume by subsampling, a smooth
/// multiplicative field, Rician noise (Gudbjartsson, Patz 1995). Deterministic, whatever the number
/// of threads. Throws UsageError, Cancelled; InputError for a part that is not closed.
imaging::Volume image_of(const std::vector<ImagedPart>& parts, const imaging::VolumeGrid& grid,
                         const ScannerOptions& options = {}, const Progress& progress = {});

}  // namespace palmar::phantom
