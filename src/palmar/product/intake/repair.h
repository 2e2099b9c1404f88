// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/product/intake/check.h"

namespace palmar::product {

/// Lengths in mm. What is unset follows from the diagonal of the product's box.
struct RepairOptions {
  std::optional<double> weld =
      std::nullopt;  ///< vertices this near become one; unset: 1e-6 of the diagonal
  std::optional<double> hole =
      std::nullopt;  ///< longest rim of a hole that is filled; unset: 0.2 of the diagonal
  std::optional<double> speck =
      std::nullopt;    ///< pieces below this diagonal go; unset: 0.01 of the diagonal; 0: none
  void check() const;  ///< throws UsageError: option, value, allowed range
};

/// What the options are for a product of this size. Throws UsageError if one is out of proportion.
struct RepairLimits {
  double weld = 0.0, hole = 0.0, speck = 0.0;  ///< mm
};
RepairLimits repair_limits(const RepairOptions& options, double diagonal);

/// One thing that was done, or that is left.
struct RepairAction {
  std::string name;  ///< "weld", "duplicates", "low triangles", "fins", "specks", "orientation",
                     ///< "holes", "touching", "edges", "crossings", "sides"
  int count = 0;     ///< how often
  std::string text;  ///< one sentence with numbers and units; of what is left: why
  std::vector<Vec3> places;  ///< where, mm; 20 at most
};

struct RepairResult {
  geometry::TriangleMesh mesh;
  RepairLimits limits;
  std::vector<RepairAction> done, left;
  bool has_changed() const { return !done.empty(); }
};

/// Repairs what can be repaired safely, in this order: vertices are welded and triangles that stand
/// there twice dropped (weld.h); triangles without height repaired (low_triangles.h); fins (small
/// sheets that hang on an edge with their other side free) and specks dropped; triangles turned
/// outwards (orient.h); small holes filled (fill_holes.h); solids that touch in an edge or a corner
/// taken apart by four times the weld's tolerance (part_sheets.h).
///
/// Left as they are, and reported: large openings, triangles that go through each other, one-sided
/// patches, walls within a solid. A mesh without faults comes back bit by bit, and what was
/// repaired stays as it is when repaired again. Deterministic. `mesh` is in mm; throws InputError
/// on coordinates that aren't finite, corners outside the list, and if no triangle has an area.
RepairResult repair_mesh(const geometry::TriangleMesh& mesh, const RepairOptions& options = {});

/// For every finding of a check that isn't as it should be: what repair_mesh() would do about it,
/// or what to do by hand. `limits` are those of the product.
std::vector<std::string> fix_list(const ProductCheck& check, const RepairLimits& limits);

}  // namespace palmar::product
