// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/geometry/types.h"

namespace palmar::geometry {

// Meshes of simple shapes: specimens, indenters and handles. All are 2-manifold with triangles
// counter-clockwise seen from outside (patches: seen from +z); lengths in mm. The vertices lie on
// the shape, so a mesh of a convex solid holds slightly less volume than the solid. Same arguments,
// same bytes. Every function throws UsageError, naming the argument, if a length is not positive
// and finite, or a count is below what closes the shape.

/// Sphere about the origin from an icosahedron, each triangle split in four `subdivisions` times
/// (0 to 8): 10 * 4^subdivisions + 2 vertices. The mean edge is about 1.15 radius / 2^subdivisions.
TriangleMesh make_icosphere(double radius, int subdivisions);

/// Box of edge lengths `size` [mm] about the origin, each face a grid of `divisions` squares per
/// side, each square cut in two.
TriangleMesh make_box(const Vec3& size, int divisions = 1);

/// Rectangle 0 <= x <= columns * spacing, 0 <= y <= rows * spacing in the plane z = 0, normal +z.
/// Vertex (i, j) has index j * (columns + 1) + i. Squares are cut along alternating diagonals.
TriangleMesh make_grid_patch(int columns, int rows, double spacing);

/// Regular triangular lattice in the plane z = 0 within `radius` of the origin, normal +z: every
/// triangle is equilateral with edge `spacing`. Vertex 0 is the origin, the others follow row by
/// row (ascending y, then x). An inner vertex has the Voronoi area spacing^2 sqrt(3) / 2.
TriangleMesh make_lattice_patch(double radius, double spacing);

struct CylinderOptions {
  double radius = 10.0;   ///< mm
  double length = 100.0;  ///< mm, along z, centred on the origin
  int segments = 48;      ///< around, at least 3
  int rings = 1;          ///< bands along the axis, at least 1
  bool is_capped = true;  ///< closed by two discs, else an open tube
  void check() const;     ///< throws UsageError: field, value, allowed range
};

/// Cylinder about the z axis. A cap is made of concentric rings about as wide as the segments, so
/// that its triangles stay well shaped.
TriangleMesh make_cylinder(const CylinderOptions& options);

/// Torus about the z axis: tube of radius `minor_radius` round a circle of radius `major_radius`
/// (larger than the tube).
TriangleMesh make_torus(double major_radius, double minor_radius, int major_segments,
                        int minor_segments);

}  // namespace palmar::geometry
