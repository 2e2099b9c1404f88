// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::imaging {

/// Where the voxels of an image are. Patient frame: that of DICOM (x to the patient's left, y to
/// the back, z to the head), mm.
struct VolumeGrid {
  std::array<int, 3> size = {0, 0, 0};                 ///< voxels along i, j, k
  Vec3 spacing = Vec3::Ones();                         ///< mm between voxel centres
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns: unit directions of i, j, k
  Vec3 origin = Vec3::Zero();                          ///< centre of voxel (0, 0, 0), mm

  std::size_t count() const { return static_cast<std::size_t>(size[0]) * size[1] * size[2]; }
  /// Index of voxel (i, j, k): i runs fastest.
  std::size_t at(int i, int j, int k) const {
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(size[0]) *
               (static_cast<std::size_t>(j) + static_cast<std::size_t>(size[1]) * k);
  }
  /// Between voxel coordinates (0 at the centre of the first voxel) and the patient frame.
  Vec3 to_patient(const Vec3& voxel) const { return origin + axes * voxel.cwiseProduct(spacing); }
  Vec3 to_voxel(const Vec3& patient) const {
    return (axes.transpose() * (patient - origin)).cwiseQuotient(spacing);
  }
};

/// A scalar image of a part of space, such as a series of MR slices. Axes are orthonormal; they may
/// be left-handed (slices stacked against their normal).
struct Volume {
  VolumeGrid grid;
  std::vector<float> value;  ///< intensity as in the file after rescaling; grid.count() of them
};

/// Intensity between voxel centres, trilinear; 0 outside of the outermost centres.
float value_at(const Volume& image, const Vec3& voxel);

}  // namespace palmar::imaging
