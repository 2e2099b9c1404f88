// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/geometry/types.h"
#include "palmar/product/product.h"

namespace palmar::product {

// Simple solids as products, about the origin; lengths in mm. The signed distance is exact (see
// analytic_distance.h); the mesh, for pictures and for maps on the product, has its vertices on the
// solid and stays within `chordal_error` of it. Each option struct's check() throws UsageError
// naming field, value and what is allowed; sizes are 0.1 mm to 10 m.

/// How fine the mesh is.
struct MeshFineness {
  double chordal_error = 0.01;  ///< mm; largest gap between mesh and solid
  double longest_edge = 3.0;    ///< mm, about; pressure maps on flat faces need points too. At most
                                ///< 400 edges per side are made.
  void check() const;
};

/// Faces (Product::faces): 1 "side", 2 "bottom", 3 "top".
struct CylinderProductOptions {
  double diameter = 48.0;
  double length = 150.0;  ///< along z
  MeshFineness fineness = {};
  void check() const;
};
Product make_cylinder_product(const CylinderProductOptions& options);

/// Bar with a filleted rectangle as section and flat, sharp-edged ends. Faces (Product::faces), as
/// far as they exist: "right" (+x), "back" (+y), "left" (-x), "front" (-y), "fillet 1" to
/// "fillet 4" (between right and back, and on counter-clockwise), "bottom" (-z), "top" (+z).
struct PrismProductOptions {
  double width = 40.0;         ///< along x
  double depth = 30.0;         ///< along y
  double length = 150.0;       ///< along z
  double fillet_radius = 5.0;  ///< of the four long edges; 0 to half of the smaller of both sides
  MeshFineness fineness = {};
  void check() const;
};
Product make_prism_product(const PrismProductOptions& options);

struct SphereProductOptions {
  double diameter = 60.0;
  MeshFineness fineness = {};
  void check() const;
};
Product make_sphere_product(const SphereProductOptions& options);

struct EllipsoidProductOptions {
  Vec3 diameters = Vec3(50.0, 60.0, 120.0);  ///< along x, y, z
  MeshFineness fineness = {};
  void check() const;
};
Product make_ellipsoid_product(const EllipsoidProductOptions& options);

/// Flat slab whose upper face is the plane z = 0.
struct PlaneProductOptions {
  double width = 300.0;     ///< along x
  double depth = 300.0;     ///< along y
  double thickness = 20.0;  ///< the slab reaches from z = -thickness to 0
  MeshFineness fineness = {};
  void check() const;
};
Product make_plane_product(const PlaneProductOptions& options);

}  // namespace palmar::product
