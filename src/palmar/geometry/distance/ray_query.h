// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::geometry {

/// Where a ray meets a mesh.
struct RayHit {
  int triangle = -1;
  double distance = 0.0;  ///< from the origin of the ray, mm
};

/// Answers ray questions about one mesh, in single precision (relative 1e-6 of the mesh's size).
/// The mesh is copied. Queries may come from several threads. Throws as ClosestPointQuery does.
class RayQuery {
 public:
  explicit RayQuery(const TriangleMesh& mesh);
  ~RayQuery();
  RayQuery(RayQuery&&) noexcept;
  RayQuery& operator=(RayQuery&&) noexcept;

  /// First triangle along `direction` (unit), farther than `from` and nearer than `to` [mm].
  std::optional<RayHit> first_hit(const Vec3& origin, const Vec3& direction, double from = 0.0,
                                  double to = std::numeric_limits<double>::infinity()) const;

  /// Every triangle along the ray beyond `from` [mm], ascending by distance. A ray through an edge
  /// or a corner may meet several triangles there, or one.
  std::vector<RayHit> all_hits(const Vec3& origin, const Vec3& direction, double from = 0.0) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace palmar::geometry
