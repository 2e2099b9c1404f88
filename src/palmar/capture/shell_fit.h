// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/imaging/volume.h"

namespace palmar {

/// What a bone's surface is found in.
struct ShellImage {
  const Volume& image;  ///< free of bias
  const std::vector<std::int32_t>&
      region;           ///< per voxel: the bone (or other bright region) it
                        ///< belongs to, -1 for none; -2 where no bone can be (air)
  double dark = 0.0;    ///< signal of cortical bone
  double bright = 0.0;  ///< of marrow
  double noise = 0.0;   ///< standard deviation of the image's noise
};

/// Where the outside of the cortical shell lies, for a surface near it.
struct ShellFit {
  TriangleMesh mesh;              ///< outer surface; adjacency of the input
  std::vector<double> thickness;  ///< of the shell, per vertex, mm
  double residual = 0.0;          ///< rms of the profiles' misfit over the contrast
};

/// Moves a closed surface that lies near a bone's shell to the shell's outside, to a fraction of a
/// voxel. Along the normal of a vertex the signal of a layered bone, blurred by the voxels'
/// size, is
///
///     I(s) = I_m (1 - P((s - a) / h)) + I_c (P((s - a) / h) - P((s - b) / h)) + I_o P((s - b) / h)
///
/// with P the normal distribution, I_m marrow, I_c cortical bone (given), I_o the tissue outside,
/// a and b the inner and outer side of the shell [mm along the normal] and h the blur: for voxels
/// of size d the standard deviation of a box is d / sqrt(12), of linear interpolation d / sqrt(6)
/// in the mean. A shell thinner than a voxel shows as a dip whose depth, not its width, tells its
/// thickness; knowing I_c, both edges are still found. I_m and I_o are solved for each (a, b)
/// (linear), the misfit is tabulated over a grid of (a, b), summed over the vertices nearby
/// (edges within about 2 mm), and its least value taken. Profiles end where another bright region
/// begins.
///
/// `own`: the bone's region. Deterministic.
ShellFit fit_shell(const TriangleMesh& near, std::int32_t own, const ShellImage& image);

}  // namespace palmar
