// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <optional>

#include "palmar/geometry/types.h"

namespace palmar::geometry {

/// Nearest point of a triangle.
struct TrianglePoint {
  Vec3 point = Vec3::Zero();                        ///< mm
  std::array<double, 3> weights = {0.0, 0.0, 0.0};  ///< barycentric, sum 1; exactly 0 on an edge
  double squared_distance = 0.0;                    ///< mm^2
};

/// Nearest point of the triangle a, b, c [mm] to `point`. Degenerate triangles (needles, points)
/// are handled as the segments they consist of.
TrianglePoint closest_point_on_triangle(const Vec3& point, const Vec3& a, const Vec3& b,
                                        const Vec3& c);

/// Nearest point of a mesh.
struct ClosestPoint {
  int triangle = -1;                                ///< the smallest index among equally near ones
  Vec3 point = Vec3::Zero();                        ///< mm
  std::array<double, 3> weights = {0.0, 0.0, 0.0};  ///< barycentric in that triangle
  double distance = 0.0;                            ///< mm, >= 0
};

/// Answers nearest-point questions about one mesh. Exact to rounding in double: a tree
/// of eight in float rejects, held a relative 1e-6 too careful, and the triangles that are left are
/// tested in double. The mesh is copied;
/// it may be open, non-manifold or degenerate. Queries are independent of their order and may come
/// from several threads. Throws InputError on a triangle corner outside the vertex list and on
/// coordinates that are not finite.
class ClosestPointQuery {
 public:
  explicit ClosestPointQuery(const TriangleMesh& mesh);
  ~ClosestPointQuery();
  ClosestPointQuery(ClosestPointQuery&&) noexcept;
  ClosestPointQuery& operator=(ClosestPointQuery&&) noexcept;

  /// Nearest point of the mesh; nothing if the mesh is empty or farther than `range` [mm]. `hint`
  /// is a triangle believed near (the answer for a neighbour, say): it saves time and never
  /// changes the answer.
  std::optional<ClosestPoint> closest(const Vec3& point,
                                      double range = std::numeric_limits<double>::infinity(),
                                      std::optional<int> hint = {}) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace palmar::geometry
