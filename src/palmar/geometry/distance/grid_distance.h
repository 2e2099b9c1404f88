// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "palmar/geometry/distance/distance_field.h"

namespace palmar::geometry {

struct GridDistanceOptions {
  double spacing = 2.0;  ///< mm between nodes; grows if the grid would have more than 20 million
  double band = 12.0;    ///< mm from the surface within which the grid answers; else the source
  /// Where the interpolated gradient is shorter, its nodes look different ways (a sharp edge, a
  /// medial surface), and the source answers. 0: never; below 1.
  double least_gradient = 0.0;
  void check() const;  ///< throws UsageError: field, value, allowed range
};

/// Quick copy of a distance field for searches (closing a grasp); take the source itself for final
/// answers. Nodes x_i keep distance d_i and gradient n_i; in a cell with trilinear weights w_i
///
///     d(q) = sum_i w_i (d_i + n_i . (q - x_i) / 2),
///
/// in which the second-order errors of interpolating values and of extending tangents cancel. On a
/// smooth surface with radii of curvature of 10 mm or more the error is below 0.02 mm at 2 mm
/// spacing. Near a sharp edge or a medial surface, where the gradient jumps, it is up to a quarter
/// of the spacing: on scans with wrinkles of the size of the spacing half of the points are within
/// 0.01 spacings, 99 % within 0.15; `least_gradient` leaves these places to the source. The normal
/// is the interpolated gradient, the closest point q - d n, the triangle -1.
class GridDistance : public DistanceField {
 public:
  explicit GridDistance(std::shared_ptr<const DistanceField> source,
                        const GridDistanceOptions& options = {});
  ~GridDistance() override;

  void sample(std::span<const Vec3> points, double range,
              std::span<DistanceSample> samples) const override;
  Box3 bounding_box() const override;
  double spacing() const;  ///< mm, as built

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace palmar::geometry
