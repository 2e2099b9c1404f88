// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "palmar/product/product.h"

namespace palmar::redesign {

/// Part of a product's surface that hands may press, with fine triangles.
struct PressRegion {
  geometry::TriangleMesh mesh;     ///< the product's, fine in the region; the surface is the same
  std::vector<int> triangle_of;    ///< per triangle of `mesh`: triangle of the product it lies on
  geometry::TriangleMesh part;     ///< triangles of the region alone ...
  std::vector<int> part_vertex;    ///< ... its vertices in `mesh`, ascending ...
  std::vector<int> part_triangle;  ///< ... its triangles in `mesh`, ascending
};

/// Triangles that lie within `margin` [mm] of where any of `skins` (product frame) reaches into the
/// product, split until no edge is longer than `edge_length` [mm]. Doesn't depend on the order of
/// the skins.
PressRegion refine_under(const product::Product& product,
                         std::span<const geometry::TriangleMesh> skins, double edge_length,
                         double margin);

}  // namespace palmar::redesign
