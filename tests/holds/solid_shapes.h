// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/product/parts/sdf_mesh_for_test.h"

namespace palmar::tests {

/// Solids for tests as functions that are negative inside. Near the surface they are about the
/// distance to it, mm; only the sign is relied on.
using Vec2 = Eigen::Vector2d;

/// Box with edges rounded by `radius`.
product::Sdf sdf_rounded_box(const Vec3& middle, const Vec3& size, double radius);
/// Solid of revolution about z from a closed outline of (radius, z); corners at radius 0 are on the
/// axis. Corners of the outline are rounded by `rounding` outwards.
product::Sdf sdf_lathe(std::vector<Vec2> outline, double rounding = 0.0);
/// Closed outline in the plane of the axes `u` and `v`, from `low` to `high` along the third.
product::Sdf sdf_extruded(std::vector<Vec2> outline, int u, int v, double low, double high);
/// Bar along a polyline whose radius changes evenly along each piece: one radius per point.
product::Sdf sdf_bar(std::vector<Vec3> line, std::vector<double> radius);
/// The shape stretched along an axis about 0: where it was at 1 mm, it is at `factor` mm.
product::Sdf sdf_stretched(const product::Sdf& shape, int axis, double factor);
/// Both, with a fillet of about `radius` where they meet.
product::Sdf sdf_blended(const product::Sdf& a, const product::Sdf& b, double radius);
product::Sdf sdf_common(const product::Sdf& a, const product::Sdf& b);  ///< what is inside both

/// Smooth curve through points (Catmull, Rom 1974), `pieces` lines between each two of them.
std::vector<Vec3> curve_through(const std::vector<Vec3>& points, int pieces = 8);
/// An ellipse in the plane of x and y, closed.
std::vector<Vec3> ellipse(const Vec3& middle, double along_x, double along_y, int pieces = 40);

/// How finely space is looked at: `usual` along each axis, mm, and other steps in some layers.
struct Lattice {
  struct Layer {
    int axis = 0;
    double from = 0.0, to = 0.0, step = 1.0;  // mm
  };
  Box3 box;
  Vec3 usual = Vec3::Constant(3.0);
  std::vector<Layer> layers;
};

/// Closed mesh of {sdf < 0} by surface nets (Gibson 1998): a vertex for each sheet of the surface
/// in a cell, on the surface, and two triangles round each edge that crosses it. Walls may be as
/// thin as a cell. `refinement`: 2 halves all steps.
geometry::TriangleMesh net_mesh_of(const product::Sdf& sdf, const Lattice& lattice,
                                   double refinement = 1.0);

}  // namespace palmar::tests
