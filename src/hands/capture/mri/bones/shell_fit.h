// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "hands/capture/mri/bones/layer_fit.h"
#include "hands/imaging/volume.h"

namespace palmar::capture {

/// What a bone's surface is found in.
struct ShellImage {
  const imaging::Volume& image;  ///< free of bias
  const std::vector<std::int32_t>&
      region;           ///< per voxel: the bone (or other bright region) it
                        ///< belongs to, -1 for none; -2 where no bone can be (air)
  double dark = 0.0;    ///< signal of cortical bone
  double bright = 0.0;  ///< of marrow
  double noise = 0.0;   ///< standard deviation of the image's noise
};

/// Moves a closed surface that lies near a bone's shell to the shell's outside (fit_layers: marrow,
/// cortical bone of known signal, whatever is outside). The blur along a normal is that of voxels
/// of size d and linear interpolation: d / sqrt(12) and d / sqrt(6) in the mean, d / 2 together.
///
/// A profile keeps what belongs to one passage: from the marrow inwards to where the shell of the
/// far side begins, outwards over the dip to the top of the next layer (behind a film of fat comes
/// a tendon or the skin); it ends where another bone or the air begins.
///
/// `own`: the bone's region. Deterministic.
LayerFit fit_shell(const geometry::TriangleMesh& near, std::int32_t own, const ShellImage& image);

}  // namespace palmar::capture
