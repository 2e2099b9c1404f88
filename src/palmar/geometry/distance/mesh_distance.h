// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "palmar/geometry/distance/distance_field.h"
#include "palmar/geometry/types.h"

namespace palmar::geometry {

/// Signed distance to a triangle mesh that may be imperfect: open, with gaps, tunnels, unshared or
/// crossing patches. Only the orientation of its patches must be right; see orient.h.
///
///     d(q) = s(q) min_t |q - x_t|,   s = -1 where w(q) > 0.5, else +1,
///
/// x_t the nearest point of triangle t, exact to rounding, and w the generalised winding number
/// (winding_number.h). Outside the bounding box and nearer than 1e-7 mm, where the side is
/// rounding, s = +1. Near a hole d jumps from -r to +r, r the distance to its rim, on a surface
/// that closes the hole.
///
/// The normal is the gradient (q - x) / d; nearer than 1e-7 mm, where that is rounding, it is the
/// angle-weighted pseudo-normal of the triangle, edge or corner (Baerentzen, Aanaes 2005).
///
/// An empty mesh is infinitely far from everywhere. Throws as ClosestPointQuery does.
class MeshDistance : public DistanceField {
 public:
  explicit MeshDistance(const TriangleMesh& mesh);
  ~MeshDistance() override;

  void sample(std::span<const Vec3> points, double range,
              std::span<DistanceSample> samples) const override;
  void resample(std::span<const Vec3> points, double range,
                std::span<DistanceSample> samples) const override;
  Box3 bounding_box() const override;
  bool is_lipschitz() const override { return is_closed(); }
  /// Interpolated over the triangle between its corners; at a corner the mean of the triangles that
  /// meet there, by their angle and by how little they are turned against this one: not at all
  /// from 45 degrees on, where an edge is meant (our choice). The gradient where it differs from
  /// the triangle's normal as much.
  Vec3 smooth_normal(const DistanceSample& sample) const override;

  /// Whether every edge is used equally often in both directions (corners at the same place count
  /// as one), so that the winding number is a whole number off the surface.
  bool is_closed() const;
  /// Generalised winding number at a point; see winding_number.h.
  double winding_number(const Vec3& point) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace palmar::geometry
