// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "palmar/capture/scan_image.h"
#include "palmar/imaging/bright_regions.h"

namespace palmar {

/// A bright region that may be the marrow of a bone, or a part of it.
struct MarrowRegion {
  std::vector<std::int32_t> regions;         ///< of BrightRegions; several where parts were joined
  std::vector<std::array<Vec3, 2>> bridges;  ///< between joined parts, patient frame
  std::vector<Vec3> voxels;        ///< centres of those brighter than half way to the dark
  std::vector<std::size_t> index;  ///< of the same voxels in the image
  double level = 0.0;              ///< mean signal
  double shell = 0.0;  ///< mean of the darkest signal within three voxels outwards: that of a shell
  double volume = 0.0;    ///< of the voxels, mm^3
  bool is_cut = false;    ///< touches the border of the image
  bool is_leaky = false;  ///< larger than the bone it stands for: its thin parts are leaks
};

/// Bright regions inside the body that are enclosed like marrow: not near the skin, nor as large as
/// the fat below it, and with something darker than marrow and muscle round most of them.
std::vector<MarrowRegion> marrow_regions(const ScanImage& scan, const BrightRegions& regions);

/// Both as one; a bridge joins them where they are nearest.
MarrowRegion joined(const MarrowRegion& a, const MarrowRegion& b);

/// Least distance between the voxels of two regions, mm.
double gap_between(const MarrowRegion& a, const MarrowRegion& b);

/// Smooth closed surface 0.8 mm round the marrow, mean edge `edge_length` [mm].
TriangleMesh marrow_surface(const ScanImage& scan, const MarrowRegion& marrow, double edge_length);

/// The piece of a surface that encloses most.
TriangleMesh largest_piece(const TriangleMesh& mesh);

}  // namespace palmar
