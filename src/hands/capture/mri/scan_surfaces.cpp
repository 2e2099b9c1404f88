// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/mri/scan_surfaces.h"

#include <fmt/format.h>

#include "palmar/core/error.h"

namespace palmar::capture {

void SurfaceOptions::check() const {
  const auto require = [](double value, double low, double high, const char* field,
                          const char* unit) {
    if (!(value >= low && value <= high)) {
      throw UsageError(fmt::format("SurfaceOptions: {} is {}; {} to {} {} are allowed", field,
                                   value, low, high, unit));
    }
  };
  require(air_threshold, 0.0, 1e9, "air_threshold", "(intensity of the file)");
  require(bone_threshold, 0.0, 1e9, "bone_threshold", "(intensity of the file)");
  require(edge_length, 0.4, 5.0, "edge_length", "mm");
  require(marker_diameter, 0.0, 20.0, "marker_diameter", "mm");
}

std::string better_scan(const ScanSurfaces& surfaces) {
  constexpr double kPixel = 0.8, kSlice = 1.0, kRounding = 0.02;  // mm; Xie 2014
  const Vec3& voxel = surfaces.voxel;
  const double slice = voxel.maxCoeff();
  const double pixel = voxel.sum() - slice - voxel.minCoeff();  // the larger one
  if (slice > 0.0 && slice <= kSlice + kRounding && pixel <= kPixel + kRounding) {
    return fmt::format(
        "a scan with less noise, of a hand that lies still (voxels of {:.2f} x "
        "{:.2f} x {:.2f} mm are fine enough)",
        voxel.x(), voxel.y(), voxel.z());
  }
  return "a finer scan with less noise (pixels of 0.8 mm, slices of 1 mm)";
}

}  // namespace palmar::capture
