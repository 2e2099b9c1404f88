// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/product/product.h"

namespace palmar::product {

enum class Severity {
  kOk,       ///< as it should be
  kNote,     ///< repaired or unusual, without harm
  kWarning,  ///< results are doubtful in places
  kError     ///< not usable
};
std::string name_of(Severity severity);  ///< "ok", "note", "warning", "error"

struct Finding {
  Severity severity = Severity::kOk;
  std::string text;  ///< one sentence with numbers and units
};

/// What is right and wrong with a product's mesh. Lengths in mm.
struct ProductCheck {
  int triangles = 0;
  int vertices = 0;
  int parts = 0;       ///< connected pieces
  int tiny_parts = 0;  ///< pieces below a hundredth of the size of the whole: dust of a scan
  int boundary_edges = 0;
  int holes = 0;                        ///< loops of boundary edges
  std::vector<double> hole_perimeters;  ///< mm, of each hole
  int non_manifold_edges = 0;
  int duplicate_triangles = 0;       ///< that stand there a second time
  int low_triangles = 0;             ///< without area: lower than a millionth of the size
  int flipped_patches = 0;           ///< that face inwards, or whose triangles disagree
  int flipped_triangles = 0;         ///< that must be turned
  int undecided_patches = 0;         ///< of which it can't be determined which side is outside
  int twisted_patches = 0;           ///< one-sided
  int crossing_pairs = 0;            ///< pairs of triangles that go through each other
  int euler_number = 0;              ///< 2 for a ball, 0 for a ring, 2 - 2 g for g tunnels, closed
  bool is_closed = false;            ///< no boundary edge
  bool is_inverted = false;          ///< closed, but its volume is negative
  bool is_too_big = false;           ///< no side below 110 mm: a hand can't reach round it
  bool is_too_small = false;         ///< longest side below 20 mm or second side below 4 mm
  double volume = 0.0;               ///< enclosed, mm^3; a guess if open
  double area = 0.0;                 ///< mm^2
  Vec3 size = Vec3::Zero();          ///< of the axis-aligned box, mm
  Vec3 extent = Vec3::Zero();        ///< along its own principal directions, ascending, mm
  std::vector<Finding> findings;     ///< the worst first
  Severity verdict = Severity::kOk;  ///< the worst of the findings
};

/// Per triangle a number of the solid that its face belongs to: bodies of a CAD model that touch
/// are different things, however near their triangles are.
std::vector<int> bodies_of_triangles(const ProductFaces& faces);

/// Examines a mesh as it is, in mm; nothing is repaired. Never throws on a bad mesh: that is a
/// finding; throws InputError only on coordinates that are not finite and corners outside the
/// vertex list. Limits of size: the widest grip of a power grasp is about 110 mm (a large hand's
/// span from thumb to fingertips, both curled), the thinnest handle that a closed fist holds 4 mm.
/// Crossing triangles take by far the longest to find and may be left out. `bodies`, per triangle,
/// are those of a CAD model (bodies_of_triangles()); they don't grow together where they touch.
ProductCheck check_mesh(const geometry::TriangleMesh& mesh, bool looks_for_crossings = true,
                        const std::vector<int>& bodies = {});

/// The same for a product, whose notes (repairs, unit) are added as findings.
ProductCheck check_product(const Product& product);

}  // namespace palmar::product
