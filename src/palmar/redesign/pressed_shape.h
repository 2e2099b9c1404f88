// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/product/product.h"
#include "palmar/redesign/imprint.h"

namespace palmar::redesign {

/// What must not be pressed.
struct KeepOut {
  std::vector<int> faces;          ///< numbers of CAD faces, ProductFace::number
  std::vector<std::string> names;  ///< their names, all faces of that name
  std::vector<Box3> boxes;         ///< product frame, mm: triangles whose box meets one
  double blend = 6.0;  ///< mm, 0 to 100: from nothing there to the full depth at this distance
  bool is_empty() const { return faces.empty() && names.empty() && boxes.empty(); }
  void add_face(const std::string& word);  ///< its number ("4") or name
};

struct PressedShapeOptions {
  double share = 0.7;  ///< of the combined depth, 0 to 1: 0 leaves the product, 1 makes room for
                       ///< the whole undeformed skin, so that nothing would press any more
  CombineOptions combine;     ///< over hands
  double depth_limit = 8.0;   ///< mm, 0.1 to 50: never deeper; what comes near is flattened
  double wall = 2.0;          ///< mm, 0 to 50: thickness that must remain
  double smoothing = 2.0;     ///< mm, 0 to 20: standard deviation of the smoothing
  double rim_width = 6.0;     ///< mm, 0.5 to 50: round the imprint, over which the depth ends
  double edge_length = 1.25;  ///< mm, 0.3 to 10: longest edge of triangles that move
  KeepOut keep_out;
  /// Direction, product frame, along which every hand's imprint is shifted onto that of all, before
  /// they are combined; nothing: hands stay where they hold. See align_imprints().
  std::optional<Vec3> align_along;
  double align_limit = 10.0;  ///< mm, 0 to 50: farthest shift
  void check() const;         ///< throws UsageError: field, value, allowed range
};

/// A product's surface pressed in where hands reach into it.
struct PressedShape {
  geometry::TriangleMesh mesh;
  std::vector<Vec3> before;      ///< where each vertex was: on the original's surface, mm
  std::vector<double> overlap;   ///< combined depth over hands per vertex, mm
  std::vector<double> depth;     ///< way of each vertex, mm
  std::vector<int> triangle_of;  ///< triangle of the original on which each triangle lies
  std::vector<double> shift;     ///< per hand along align_along, mm; empty if not aligned
  int hands = 0;

  double removed_volume = 0.0;  ///< mm^3
  double deepest = 0.0;         ///< mm
  Vec3 deepest_at = Vec3::Zero();
  double pressed_area = 0.0;   ///< mm^2 of the original's surface deeper than 0.1 mm
  double thinnest_wall = 0.0;  ///< mm, under pressed vertices; infinity if none
  // Area of the original's surface where the depth is at least 0.05 mm less because of ...
  double limited_by_depth = 0.0;     ///< the depth limit, mm^2
  double limited_by_wall = 0.0;      ///< the wall
  double limited_by_keep_out = 0.0;  ///< the keep-out and its blend
  double limited_by_crossing = 0.0;  ///< the surface would have crossed itself or folded
};

/// The product's surface offset inwards by a share of how deep hands' skins reach into it (Xie
/// 2014, 5.5.4, "redesign 1": concaves of finger shape). `skins`: posed, undeformed, product frame.
///
/// 1. Triangles are made anew, nearly equilateral, no edge longer than edge_length: all of a CAD
///    file's, of a scan's those near any imprint.
/// 2. Outward normals are smoothed along the surface to directions m, so that on both sides of an
///    edge they turn steadily; depths are measured along -m (imprint.h), and vertices go that way.
///    So at share 1 every vertex lands on the skin, on faces and at edges alike.
/// 3. Combined over hands, times share, smoothed along the surface, taken back to nothing over
///    rim_width round the imprint; creases of pressed edges are smoothed away, deeper; then held
///    below the limits by a curve without a kink.
/// 4. Where the result would cross itself, fold or leave less than `wall`, a quarter of the depth
/// is
///    taken back there and within 10 mm, until it does no more.
///
/// Elsewhere the surface stays, of a scan with its triangles; the mesh stays closed if it was;
/// volume never grows. The same result for any order of hands and any number of threads. Throws
/// UsageError on bad options, no skins, or a keep-out face that doesn't exist; Cancelled.
PressedShape press_shape(const product::Product& product,
                         std::span<const geometry::TriangleMesh> skins,
                         const PressedShapeOptions& options = {}, const Progress& progress = {});

/// The pressed shape as a product to be held: faces are those of the original, with their triangles
/// and areas as they are now.
product::Product pressed_product(const product::Product& original, const PressedShape& shape,
                                 const std::string& name);

}  // namespace palmar::redesign
