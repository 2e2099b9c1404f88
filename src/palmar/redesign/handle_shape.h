// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/product/product.h"
#include "palmar/redesign/handle_body.h"

namespace palmar {

/// A handle shaped anew: features on the place of what is there.
struct HandleShape {
  HandleBody body = {};
  HandleFeatures features = {};
  double end_radius = 0.0;  ///< of the edges round flat ends, mm
  double kept_ends = 0.0;   ///< mm at both flat ends with the outlines that they have now
  /// Product frame, mm: what lies in them keeps its outline; beside them the features begin over
  /// 14 mm.
  std::vector<Box3> kept_boxes = {};

  /// Point of the side in the plane of z, handle frame, mm; `t` goes round once from 0 to 1. The
  /// original's outline where ends are kept and where the shape has run out, that of the features
  /// in the middle.
  Eigen::Vector2d side_point(double z, double t) const;
  /// Its distance from the centre line in direction phi, mm.
  double radius_at(double z, double phi) const;
  /// Share of the features in the plane of z in direction phi, 0 to 1.
  double share_at(double z, double phi) const;
};

/// How a shape differs from what is there, over the length that is shaped.
struct ShapeChange {
  double largest = 0.0;          ///< mm, outwards or inwards, from the centre line
  double volume_ratio = 1.0;     ///< by the volume before
  double smallest_radius = 0.0;  ///< mm; of the curvature of its sections, where they bulge
};
ShapeChange shape_change(const HandleShape& shape);

/// A whole handle (HandleBody::is_whole) as a closed mesh, product frame: quadrilaterals of about
/// `edge_length` mm, halved, rounded edges and flat ends.
TriangleMesh handle_mesh(const HandleShape& shape, double edge_length = 1.5);

/// The product's mesh, its vertices on the handle moved across the centre line onto the shape;
/// edges there are split to `edge_length` [mm] before. Round free ends keep their form and become
/// as wide as the section before them. A closed mesh stays closed.
TriangleMesh moved_mesh(const TriangleMesh& mesh, const HandleShape& shape,
                        double edge_length = 2.0);

/// Either of the two, whichever suits the body, as a product.
Product shaped_product(const Product& original, const HandleShape& shape, const std::string& name);

}  // namespace palmar
