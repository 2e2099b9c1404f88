// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::product {

/// Right-handed frame of a plane: points are centre + x u + y v.
struct PlaneFrame {
  Vec3 centre, u, v, normal;
  PlaneFrame(const Vec3& through, const Vec3& unit_normal);
  Eigen::Vector2d project(const Vec3& p) const { return {u.dot(p - centre), v.dot(p - centre)}; }
  Vec3 lift(const Eigen::Vector2d& p) const { return centre + p.x() * u + p.y() * v; }
};

/// What a tape and a caliper say of points of a plane: their convex hull.
struct OutlineMeasures {
  Vec3 centre = Vec3::Zero();                        ///< of the outline's area, mm
  double area = 0.0;                                 ///< mm^2
  double girth = 0.0, width = 0.0, thickness = 0.0;  ///< see PartSection, mm
  Vec3 wide = Vec3::UnitX();
};

/// Nothing for points on one line.
std::optional<OutlineMeasures> measure_hull(const PlaneFrame& plane,
                                            const std::vector<Eigen::Vector2d>& points);

/// Twice the signed area of a polygon, and whether it holds a point.
double twice_area(const std::vector<Eigen::Vector2d>& polygon);
bool holds(const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& point);
/// From a polygon's outline.
double distance_to(const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& point);

/// How outline_at() chooses outlines, mm.
struct OutlineReach {
  double reach = 20.0;  ///< an outline that doesn't hold the point is at most so far away
  double gap = 0.0;     ///< outlines less than that apart count as one, if alike in size
};

/// The outer outline of the solid that holds `point`, else the one nearest to it, in the plane
/// through it across `axis`, and what a gap (a hole to hang the product up) parts from it; centre
/// and area are those of the outlines, the rest those of their hull.
std::optional<OutlineMeasures> outline_at(const geometry::TriangleMesh& mesh, const Vec3& point,
                                          const Vec3& axis, const OutlineReach& reach);

/// All of an open or closed piece of surface that the plane meets, as one hull.
std::optional<OutlineMeasures> hull_at(const geometry::TriangleMesh& mesh, const Vec3& point,
                                       const Vec3& axis);

}  // namespace palmar::product
