// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "palmar/contact/response/skin_geometry.h"
#include "palmar/hand/anatomy.h"

namespace palmar::contact {

/// Area in contact, reported vertex by vertex (mm^2; 0 where not loaded), so that a part's area is
/// the sum over its vertices. A triangle with all corners loaded counts in full, one with some
/// loaded counts as far as the edge of the contact reaches into it: on a triangle's edge of length
/// l between a loaded vertex (pressure p) and one that is lifted (gap g) the edge of the contact
/// stands at x from the loaded one, where
///
///     p = K sqrt(x),   g = (4 K / 3 E*) (l - x)^1.5,   E* = 4 G
///
/// (the only way in which a smooth contact of elastic solids can end, with any K; Johnson 1985,
/// sections 4.2, 5.1). Counting whole cells instead is 5-30 % too much for contacts a few cells
/// wide.
/// `pressure` [MPa], `gap` [mm] and `shear_modulus` [MPa] stand per vertex.
std::vector<double> contact_area(const std::vector<Vec3>& positions,
                                 const std::vector<Triangle>& triangles,
                                 const std::vector<double>& pressure,
                                 const std::vector<double>& gap,
                                 const std::vector<double>& shear_modulus);

/// Largest mean pressures over a sensor cell, MPa.
struct CellPeaks {
  double own = 0.0;  ///< of the load on the region that the cell is centred on
  double all = 0.0;  ///< of all load
};

/// Peaks over the cells centred on `centres`. The cell is a disc of `cell_area` [mm^2] on the skin;
/// each vertex' force spreads evenly over the disc of its Voronoi area, and the part of it that
/// lies in the cell counts (SensorCells). Skin without load counts as 0. `force` [N] and `region`
/// stand per vertex. On skin as it is pressed (pressed_skin.h) the cells lie on the product, as
/// those of a mat do.
CellPeaks peak_over_cells(const SkinGeometry& skin, std::span<const int> centres,
                          const std::vector<double>& force, const std::vector<hand::Region>& region,
                          double cell_area);

}  // namespace palmar::contact
