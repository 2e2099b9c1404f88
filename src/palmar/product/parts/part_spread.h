// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/geometry/types.h"

namespace palmar {

/// Axes of a piece of surface, most spread first, with the spreads (standard deviations, mm).
struct Spread {
  Vec3 middle = Vec3::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Vec3 size = Vec3::Zero();
};

Spread spread_of(const TriangleMesh& piece);

/// Principal directions that a piece of surface faces, most area first; `size` is the root of their
/// shares.
Spread facing_of(const TriangleMesh& piece);

/// Mean of the points of a surface, by area.
Vec3 surface_middle(const TriangleMesh& mesh);

/// Extents along the columns of `axes`, mm.
Vec3 extents_of(const TriangleMesh& piece, const Eigen::Matrix3d& axes);

/// Farthest / root mean square distance of a surface from its middle.
double roundness_of(const TriangleMesh& piece, const Spread& spread);

/// The axis of a long body is its longest; of one as long as wide the one that it is round about:
/// it shows in where the surface lies or in where it faces.
Vec3 body_axis(const Spread& spread, const Spread& facing);

}  // namespace palmar
