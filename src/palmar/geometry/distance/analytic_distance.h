// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <memory>

#include "palmar/geometry/distance/distance_field.h"

namespace palmar::geometry {

// Exact signed distances of simple solids, in the solid's own frame; lengths in mm. Negative
// inside; the normal is the gradient, at a sharp edge the middle of its two faces. Where several
// points are nearest (centre of a sphere, axis of a cylinder) one of them is taken. Every function
// throws UsageError, naming the argument, its value and what is allowed.

using DistanceFieldPtr = std::shared_ptr<const DistanceField>;

/// Ball about the origin.
DistanceFieldPtr make_sphere_distance(double radius);

/// Everything below z = 0. The bounding box is the plane's part within 1 m of the origin.
DistanceFieldPtr make_half_space_distance();

struct CylinderShape {
  double radius = 10.0;
  double length = std::numeric_limits<double>::infinity();  ///< along z, centred on the origin
  double edge_radius = 0.0;  ///< of the rounding where end meets side; at most radius, length / 2
  void check() const;
};
DistanceFieldPtr make_cylinder_distance(const CylinderShape& shape);

/// Box of edge lengths `size` about the origin, all edges rounded by `edge_radius` (at most half
/// the smallest edge).
DistanceFieldPtr make_box_distance(const Vec3& size, double edge_radius = 0.0);

/// Box of edge lengths `size` whose upper face is the plane z = 0, centred in x and y.
DistanceFieldPtr make_slab_distance(const Vec3& size);

struct PrismShape {
  double width = 40.0;         ///< along x
  double depth = 30.0;         ///< along y
  double length = 120.0;       ///< along z; all centred on the origin
  double fillet_radius = 5.0;  ///< of the four long edges; at most half of width and of depth
  void check() const;
};
/// Bar with filleted long edges and flat, sharp-edged ends.
DistanceFieldPtr make_prism_distance(const PrismShape& shape);

/// Ellipsoid about the origin with semi-axes a, b, c along x, y, z. The nearest point x of q solves
/// x_i = a_i^2 q_i / (t + a_i^2), sum (x_i / a_i)^2 = 1, found by Newton's method from the side
/// from which it can't overshoot. Source: Eberly 2013, Distance from a point to an ellipse, an
/// ellipsoid, or a hyperellipsoid, section 3.
DistanceFieldPtr make_ellipsoid_distance(const Vec3& semi_axes);

}  // namespace palmar::geometry
