// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/geometry/mesh/boundary_loops.h"
#include "palmar/geometry/types.h"

namespace palmar::geometry {

struct FillHolesOptions {
  double longest_perimeter = 30.0;  ///< mm; longer holes stay open
  /// mm; holes whose patch is narrower than this in the mean are cracks: filled, however long.
  double crack_width = 0.0;
  /// A patch may have this share of the area of the piece that it closes, at most: more is an
  /// opening, not a hole.
  double largest_share = 1.0 / 3.0;
  void check() const;  ///< throws UsageError: field, value, allowed range
};

/// One hole and what became of it.
struct HoleOutcome {
  BoundaryLoop loop;  ///< corners of the input
  bool is_filled = false;
  std::string reason;  ///< why it was left open, with numbers and units; "" if filled
  int triangles = 0;   ///< that fill it
  double area = 0.0;   ///< of them, mm^2
};

struct FillHolesResult {
  TriangleMesh mesh;               ///< first the vertices and triangles of the input, in order
  std::vector<HoleOutcome> holes;  ///< in order of find_boundary_loops()
  int filled = 0;
};

/// Closes the small holes of an oriented mesh.
///
/// 1. Each rim is triangulated with least area: exactly for up to 200 corners, by cutting the
///    sharpest ear for more. Edges that the mesh has already are left out, so no edge gets a third
///    triangle.
/// 2. The patch is refined until its edges are as long as the rim's, with Delaunay flips.
/// 3. Its vertices are moved so that it goes on as smoothly as the surface round it: least squares
///    of the discrete Laplacian over the patch and its rim.
/// 4. A patch that folds or goes through the surface is tried again flat (without step 3), then
///    without refinement; if that crosses, too, the hole stays open.
///
/// Left open, with the reason: holes (but no cracks) longer than the limit, patches larger than the
/// share, holes round which something else has an open edge (an island), rims that fit no patch.
///
/// Deterministic. Throws InputError on coordinates that aren't finite and corners outside the list.
///
/// Sources: Barequet, Sharir 1995, "Filling gaps in the boundary of a polyhedron", section 4; Liepa
/// 2003, "Filling holes in meshes", sections 3 to 5.
FillHolesResult fill_holes(const TriangleMesh& mesh, const FillHolesOptions& options = {});

}  // namespace palmar::geometry
