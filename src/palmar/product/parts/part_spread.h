// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/geometry/types.h"

namespace palmar::product {

/// Axes of a piece of surface, most spread first, with the spreads (standard deviations, mm).
struct Spread {
  Vec3 middle = Vec3::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Vec3 size = Vec3::Zero();
};

Spread spread_of(const geometry::TriangleMesh& piece);

/// Principal directions that a piece of surface faces, most area first; `size` is the root of their
/// shares.
Spread facing_of(const geometry::TriangleMesh& piece);

/// The three directions that a piece of surface faces most sharply: the orthonormal axes a_k with
/// the largest sum of A (n . a_k)^4 (quartimax, Neuhaus, Wrigley 1954). Of a cube, whose principal
/// directions are all alike, they are still those of its faces.
struct FaceAxes {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  /// How closely the normals gather at the axes, in the plane of any two where they do so least:
  /// 1 of a box, 0 of something round about one of the axes.
  double sharpness = 0.0;
  bool is_box() const;
};

FaceAxes face_axes_of(const geometry::TriangleMesh& piece);

/// Mean of the points of a surface, by area.
Vec3 surface_middle(const geometry::TriangleMesh& mesh);

/// Extents along the columns of `axes`, mm.
Vec3 extents_of(const geometry::TriangleMesh& piece, const Eigen::Matrix3d& axes);

/// Farthest / root mean square distance of a surface from its middle.
double roundness_of(const geometry::TriangleMesh& piece, const Spread& spread);

/// The axis of a box is the longest way between its faces, that of another long body the direction
/// in which it spreads most. One as long as wide has the axis that it is round about: it shows in
/// where the surface lies or in where it faces. Flat ends about across it give it its direction.
Vec3 body_axis(const geometry::TriangleMesh& piece, const Spread& spread, const Spread& facing);

/// The axis of a plate, in its plane: of a box the longer way between its edges, else the direction
/// in which it spreads most.
Vec3 plate_axis(const geometry::TriangleMesh& piece, const Spread& spread, const Vec3& normal);

}  // namespace palmar::product
