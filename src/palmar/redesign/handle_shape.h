// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/product/product.h"
#include "palmar/redesign/handle_body.h"

namespace palmar::redesign {

/// Roundings of flat ends turn by 75 degrees and meet the ends at the remaining 15: where a
/// rounding meets a flat end without an edge, OpenCASCADE opens shells there wrongly.
inline constexpr double kEndAngle = 75.0 / 180.0 * std::numbers::pi;

/// Of what is made anew, mm: so that an end isn't felt as an edge, and a shell of 2 mm can be
/// opened there; our choice.
inline constexpr double kLeastEndRadius = 3.0;

/// Where a surface goes through a handle's outlines as they are, without features: in planes
/// `distance` [mm] apart, about, in these directions [rad], ascending from 0, a multiple of eight.
struct OutlineGrid {
  std::vector<double> directions;
  double distance = 0.0;
};
/// Directions that part the mean outline evenly, `distance` [mm] apart, about.
OutlineGrid outline_grid(const HandleOutlines& outlines, double distance);

/// A handle shaped anew: features on the place of what is there.
struct HandleShape {
  HandleBody body = {};
  HandleFeatures features = {};
  double end_radius = 0.0;  ///< of the edges round flat ends, over kEndAngle, mm
  std::array<double, 2> kept_ends = {0.0, 0.0};  ///< mm at the flat bottom and top that keep the
                                                 ///< outlines that they have now
  // Kept, too; beside them the features begin over 14 mm.
  std::vector<Box3> kept_boxes = {};         ///< product frame, mm: what lies in them
  std::vector<std::string> kept_faces = {};  ///< CAD faces, by number or name
  HandleOutlines to_kept_faces = {};         ///< distance to those in place of radii, mm; or empty
  /// In place of features and of all that is kept beside them: the outlines everywhere.
  std::optional<OutlineGrid> follows = {};

  /// Whether some of the original's outlines are in the shape.
  bool keeps() const;

  /// Point of the side in the plane of z, handle frame, mm; `t` goes round once from 0 to 1. The
  /// original's outline where ends are kept and where the shape has run out, that of the features
  /// in the middle.
  Eigen::Vector2d side_point(double z, double t) const;
  /// Its distance from the centre line in direction phi, mm.
  double radius_at(double z, double phi) const;
  /// The original's distance there, without the rounding of its flat ends, mm.
  double radius_before(double z, double phi) const;
  /// Share of the features in the plane of z in direction phi, 0 to 1.
  double share_at(double z, double phi) const;
};

/// Through which points the shape's surface goes: in planes `distance` [mm] apart, about, `columns`
/// round each, from kFirstTurn on.
struct HandleRows {
  static constexpr double kFirstTurn = 0.125;  ///< half of a face, so that none has its seam within
  int columns = 0;                             ///< a multiple of eight
  double distance = 0.0;
  double end_radius = 0.0;  ///< mm; 0 of a part of a product
};
HandleRows rows_for(const HandleShape& shape);

/// The tightest radius, mm, at which the outlines of flat ends bulge: what rounds their edges must
/// be tighter.
double tightest_at_ends(const HandleShape& shape);

/// How a shape differs from what is there, over the length that is shaped.
struct ShapeChange {
  double largest = 0.0;          ///< mm, outwards or inwards, from the centre line
  double volume_ratio = 1.0;     ///< by the volume before
  double smallest_radius = 0.0;  ///< mm; of the curvature of its sections, where they bulge
};
ShapeChange shape_change(const HandleShape& shape);

/// A whole handle (HandleBody::is_whole) as a closed mesh, product frame: quadrilaterals of about
/// `edge_length` mm, halved, rounded edges and flat ends.
geometry::TriangleMesh handle_mesh(const HandleShape& shape, double edge_length = 1.5);

/// The product's mesh, its vertices on the handle moved across the centre line onto the shape;
/// edges there are split to `edge_length` [mm] before. Round free ends keep their form and become
/// as wide as the section before them. A closed mesh stays closed.
geometry::TriangleMesh moved_mesh(const geometry::TriangleMesh& mesh, const HandleShape& shape,
                                  double edge_length = 2.0);

/// Either of the two, whichever suits the body, as a product.
product::Product shaped_product(const product::Product& original, const HandleShape& shape,
                                const std::string& name);

}  // namespace palmar::redesign
