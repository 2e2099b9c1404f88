// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::geometry {

/// A vertex and its distance along the surface from a source, mm.
struct GeodesicReach {
  int vertex = 0;
  double distance = 0.0;
};

/// Memory of one thread for GeodesicSolver; reuse it from call to call.
class GeodesicWorkspace {
 private:
  friend class GeodesicSolver;
  std::vector<double> distance_;  // per vertex; infinity unless touched in the current call
  std::vector<double> expanded_;  // distance at which a vertex was last expanded
  std::vector<int> touched_;
  std::vector<std::vector<int>> bucket_;
  std::vector<GeodesicReach> result_;
};

/// Lengths of shortest paths along a triangle mesh, from one vertex to those near it.
///
/// Distances grow from the source by three rules, until none gives a shorter one:
///   edge:     D(b) <= D(a) + |ab|;
///   diagonal: D(w) <= D(v) + |vw| in the plane of two unfolded neighbouring triangles, where the
///             line v w crosses their common edge;
///   wave:     two known corners v, a of a triangle fix a point S in its plane (beyond the edge v
///   a)
///             with |Sv| = D(v), |Sa| = D(a); D(b) <= |Sb| where the line S b crosses the edge v a.
/// A circular wave on a plane is exact. In general distances are those of a path on the surface, or
/// off by the curvature that the wave met before it entered the triangle: 0.1 % of the distance on
/// a hand of 2.5 mm edges. D(i, j) and D(j, i) differ by as little. Behind a corner of a border,
/// round which a path bends, they are up to 1 % too long. Paths don't cross a cut.
/// Non-manifold edges are allowed, vertices without a path stay unreached.
///
/// The wave rule never gives a smaller D(b) for a larger D(v) or D(a), so the order of the updates
/// can't make a distance too short, and buckets serve instead of a sorted front.
///
/// Source: Sethian, Kimmel 1998 (fast marching on meshes); Novotni, Klein 2002 (circular waves);
/// Bertsekas 1998, section 2.4 (label correcting).
class GeodesicSolver {
 public:
  /// Throws InputError on a corner outside the vertex list. Triangles without area are left out,
  /// but their edges serve as paths. The mesh needn't live on.
  explicit GeodesicSolver(const TriangleMesh& mesh);

  /// Vertices within `radius` [mm] of vertex `source`, the source first, the others in a fixed
  /// order that is only roughly ascending. If `allowed` is not empty it has one byte per vertex,
  /// and paths keep to triangles (and edges) all of whose vertices are non-zero there; a source
  /// that is not allowed reaches nothing. The span is valid until the workspace is used again.
  /// Several threads may call at once, each with its own workspace. Throws UsageError for a source
  /// outside the mesh or an `allowed` of the wrong size.
  std::span<const GeodesicReach> reach(int source, double radius, GeodesicWorkspace& workspace,
                                       std::span<const unsigned char> allowed = {}) const;

  /// Distance from `source` to every vertex; infinity where it isn't reached within `radius`.
  std::vector<double> distances(int source,
                                double radius = std::numeric_limits<double>::infinity()) const;

  int vertex_count() const { return static_cast<int>(begin_.size()) - 1; }

 private:
  // Geometry of up to eight triangles side by side, seen from one of their vertices, v. Empty
  // places have infinite lengths.
  struct alignas(64) Corners {
    std::array<double, 8> va, vb;      // lengths, mm
    std::array<double, 8> inverse_va;  // 1 / va
    std::array<double, 8> inverse_vb;
    std::array<double, 8> cosine, sine;  // of the angle at v
    // |v across| unfolded; infinity if there is none or the line misses the edge a b
    std::array<double, 8> diagonal;
    std::array<int, 8> a, b;    // the other corners
    std::array<int, 8> across;  // apex of the triangle beyond the edge a b
  };
  struct Front;  // one run

  std::vector<int> begin_;  // vertex_count + 1: its corners
  std::vector<Corners> corners_;
  std::vector<int> needle_begin_;  // vertex_count + 1: edges that only needles have
  std::vector<GeodesicReach> needle_;
  double bucket_width_ = 1.0;
};

/// Symmetric table of the distances between given vertices, in rows: entries begin[i] to
/// begin[i + 1] - 1 hold, ascending, the places j in `vertices` with D(i, j) <= radius, i itself
/// included. D is that from the earlier to the later of the two. Single precision: the rounding of
/// 6e-8 is far below the error of D, and the tables are large.
struct GeodesicTable {
  std::vector<int> begin;
  std::vector<int> place;
  std::vector<float> distance;  ///< mm
};

/// Table of `vertices` (no vertex twice: UsageError). Runs on the threads of parallel_for(); the
/// result doesn't depend on their number. `allowed` as for reach().
GeodesicTable geodesic_table(const GeodesicSolver& solver, std::span<const int> vertices,
                             double radius, std::span<const unsigned char> allowed = {});

}  // namespace palmar::geometry
