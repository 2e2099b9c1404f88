// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "hands/capture/mri/scan_image.h"

namespace palmar::capture {

/// A bright region that may be the marrow of a bone, or a part of it.
struct MarrowRegion {
  std::vector<std::int32_t> regions;         ///< of MarrowRegions::region
  std::vector<std::array<Vec3, 2>> bridges;  ///< between joined parts, patient frame
  std::vector<Vec3> voxels;        ///< centres of those brighter than half way to the dark
  std::vector<std::size_t> index;  ///< of the same voxels in the image
  double level = 0.0;              ///< mean signal
  double shell = 0.0;  ///< mean of the darkest signal within three voxels outwards: that of a shell
  double volume = 0.0;  ///< of the voxels, mm^3
  double open = 0.0;    ///< share of its border with nothing dark outside, or with skin at once
  /// Share of pairs of voxels whose middle lies in the region as well: nearly 1 for marrow, less
  /// for fat, which bends round bones. Of joined regions, the mean of the parts.
  double convexity = 1.0;
  bool is_cut = false;    ///< touches the border of the image
  bool is_leaky = false;  ///< larger than the bone it stands for: its thin parts are leaks
};

/// What may be the marrow of a bone.
struct MarrowRegions {
  std::vector<std::int32_t> region;      ///< per voxel; -1 for none
  int count = 0;                         ///< of these regions
  std::vector<MarrowRegion> candidates;  ///< one or several regions each; some overlap
};

/// Bright regions (bright_regions.h) inside the mask that are enclosed like marrow: not near the
/// skin, nor as large as the fat below it, and with something darker than marrow and muscle round
/// most of them: up to 0.62 of the way from cortical bone to the region's own level, or more or
/// less as ScanLevels::bone_share() is above or below a half. Regions are separated by films of two
/// depths: those that only deep films separate hold several of the others, and overlap with them as
/// candidates.
MarrowRegions marrow_regions(const ScanImage& scan, const imaging::VoxelMask& inner);

/// Whether two candidates hold the same region.
bool overlap(const MarrowRegion& a, const MarrowRegion& b);

/// Both as one; a bridge joins them where they are nearest.
MarrowRegion joined(const MarrowRegion& a, const MarrowRegion& b);

/// Least distance between the voxels of two regions, mm.
double gap_between(const MarrowRegion& a, const MarrowRegion& b);

/// Smooth closed surface 0.8 mm round the marrow, mean edge `edge_length` [mm].
geometry::TriangleMesh marrow_surface(const ScanImage& scan, const MarrowRegion& marrow,
                                      double edge_length);

/// The piece of a surface that encloses most.
geometry::TriangleMesh largest_piece(const geometry::TriangleMesh& mesh);

}  // namespace palmar::capture
