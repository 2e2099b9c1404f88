// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/hand/anatomy.h"
#include "palmar/hand/skeleton.h"

namespace palmar::hand {

/// Skin cut into the 15 segments and the 19 regions (with the dorsum 20).
struct SkinPartition {
  /// Same vertices in the same order, those near a crease slid along the surface onto it, so that
  /// the creases run along edges of the mesh; where that made slivers, edges are turned.
  geometry::TriangleMesh skin;
  std::vector<Segment> segment;  ///< per vertex
  std::vector<Region> region;    ///< per vertex
};

/// Partitions a skin by the creases of creases.h.
///
/// Every vertex takes the label of its place; islands fall to their surroundings. Then of every
/// edge that crosses a crease the nearer end is moved onto the crease, the vertices near creases
/// are relaxed along the surface (those on a crease stay on it), and a vertex on a crease takes the
/// label with the higher standing: palmar skin before dorsum, phalanges before palm, proximal
/// before distal. So each region is closed on one side and open on the other, everywhere alike.
///
/// The stub of the forearm counts as segment palm, region dorsum.
///
/// `skin` must be closed and 2-manifold, its edges at most about a quarter of the shortest phalanx
/// (the template has 2.5 mm). Throws InputError if it is not, or if a segment or region stays
/// empty. A mirrored hand gives the mirrored partition. Deterministic.
SkinPartition partition_skin(const geometry::TriangleMesh& skin, const Skeleton& skeleton);

/// Region of each triangle of a partitioned skin: that of its corner of lowest standing, because a
/// corner on a crease carries the label of highest standing. With it pictures show creases as the
/// clean lines that they are.
std::vector<Region> triangle_regions(const std::vector<Triangle>& triangles,
                                     const std::vector<Region>& region);

}  // namespace palmar::hand
