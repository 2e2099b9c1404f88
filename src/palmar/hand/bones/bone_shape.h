// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::hand {

/// Half width (lateral) and half depth (palmar-dorsal) of a bone at a share of its length.
struct BoneStation {
  double share = 0.0;
  double half_width = 0.0, half_depth = 0.0;  ///< mm
};

/// A long bone: cross-sections along a straight axis, rounded at both ends.
struct BoneShape {
  /// Ends of the axis. A grooved head ends short of `to` by up to the depth of the groove.
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();
  Vec3 palmar = Vec3::UnitZ();       ///< unit, about perpendicular to the axis
  std::vector<BoneStation> station;  ///< ascending share, at least two; smooth in between
  double base_cap = 0.0;             ///< length over which the base rounds off, mm
  double head_cap = 0.0;             ///< same at the head
  double groove = 0.0;               ///< depth of the groove between two condyles, mm; 0: none
  int rings = 18, around = 20;
};

/// Closed mesh of rings * around + 2 vertices, triangles outward.
geometry::TriangleMesh bone_mesh(const BoneShape& shape);

/// Ellipsoid with half axes along the columns of `axes` (orthonormal), as rings and two poles.
geometry::TriangleMesh ellipsoid_mesh(const Vec3& centre, const Eigen::Matrix3d& axes,
                                      const Vec3& half_axes, int rings, int around);

/// Closed mesh of rings of `around` vertices between two poles, `vertices` from the first pole to
/// the last; triangles outward.
geometry::TriangleMesh close_rings(std::vector<Vec3> vertices, int around);

}  // namespace palmar::hand
