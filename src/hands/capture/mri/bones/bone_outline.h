// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "hands/capture/mri/bones/bone_regions.h"

namespace palmar::capture {

inline constexpr double kCorticalShell = 0.8;  ///< mm of cortical bone round marrow

/// What a bone looks like from far: enough to determine which one it is.
struct BoneOutline {
  Vec3 centre = Vec3::Zero();  ///< of the volume, mm
  Vec3 axis = Vec3::UnitX();   ///< unit, along the bone; either way round
  double length = 0.0;         ///< along it, mm
  double width = 0.0;          ///< mean extent across, mm
  std::array<Vec3, 2> ends = {Vec3::Zero(), Vec3::Zero()};  ///< where the axis leaves the bone
};
BoneOutline outline_of(const geometry::TriangleMesh& mesh);
/// Of the bone round a marrow: by the cortical shell longer at each end, and wider all round.
BoneOutline outline_of(const MarrowRegion& marrow);

}  // namespace palmar::capture
