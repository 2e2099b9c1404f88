// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <vector>

namespace palmar {

// Words of all modules.

using Vec3 = Eigen::Vector3d;
using Quat = Eigen::Quaterniond;

/// Corner indices of one triangle, counter-clockwise seen from outside.
using Triangle = std::array<int, 3>;

/// Axis-aligned box, mm. Empty (lower > upper) until a point is added.
using Box3 = Eigen::AlignedBox3d;

}  // namespace palmar

namespace palmar::geometry {

/// Indexed triangle mesh; mm. A plain value: operations return new meshes. Vertex order is part of
/// the value (fields on a mesh are vectors in the same order).
struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;

  int vertex_count() const { return static_cast<int>(vertices.size()); }
  int triangle_count() const { return static_cast<int>(triangles.size()); }
};

}  // namespace palmar::geometry
