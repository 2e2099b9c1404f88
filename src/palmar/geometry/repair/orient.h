// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::geometry {

/// A mesh whose triangles are counter-clockwise seen from outside, and what that took.
struct OrientResult {
  TriangleMesh mesh;                   ///< same vertices, same triangle order
  std::vector<int> flipped_triangles;  ///< ascending
  int patches = 0;            ///< runs of triangles joined over edges that exactly two share
  int flipped_patches = 0;    ///< turned as a whole
  int repaired_patches = 0;   ///< triangles of one patch disagreed with each other
  int twisted_patches = 0;    ///< one-sided (Moebius band): no orientation agrees everywhere
  int undecided_patches = 0;  ///< rays don't show outside from inside; left as they were
};

/// Repairs orientation patch by patch.
///
/// 1. Inside a patch, neighbours are made to agree; the majority by area stays.
/// 2. A closed patch must enclose a positive volume unless it lies within another one: there both a
///    cavity (negative) and a solid within a solid (positive) are meant by somebody, so it stays.
/// 3. An open patch is decided by rays from both sides of many of its triangles: outside is where a
///    ray leaves the mesh after an even number of crossings, and, where parity doesn't show, where
///    more rays leave without any crossing (Takayama, Jacobson, Kavan, Sorkine-Hornung 2014,
///    parity and visibility voting).
///
/// Deterministic. Throws InputError on corners outside the vertex list and on coordinates that are
/// not finite.
OrientResult orient_outwards(const TriangleMesh& mesh);

}  // namespace palmar::geometry
