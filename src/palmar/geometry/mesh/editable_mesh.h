// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::geometry {

/// A 2-manifold mesh whose edges can be split, collapsed and flipped. Every operation either keeps
/// the mesh 2-manifold and oriented, with the same Euler number and the same borders (as curves),
/// or is refused and changes nothing. Positions are free; operations look at adjacency alone.
///
/// Half-edge h = 3 t + k runs from corner k of triangle t to the next corner, as in MeshTopology.
/// Removed triangles and vertices keep their index until compacted().
///
/// Source: Hoppe et al. 1993, "Mesh optimization", section 3 (which collapses are legal); Dey et
/// al. 1999 (link condition).
class EditableMesh {
 public:
  /// Throws InputError unless `mesh` is 2-manifold and consistently oriented.
  explicit EditableMesh(const TriangleMesh& mesh);

  int vertex_capacity() const { return static_cast<int>(position_.size()); }
  int half_edge_capacity() const { return static_cast<int>(start_.size()); }
  bool has_vertex(int v) const { return outgoing_[v] >= 0; }
  bool has_half_edge(int h) const { return start_[h] >= 0; }

  static int next(int h) { return h % 3 == 2 ? h - 2 : h + 1; }
  static int previous(int h) { return h % 3 == 0 ? h + 2 : h - 1; }
  int start(int h) const { return start_[h]; }
  int end(int h) const { return start(next(h)); }
  int apex(int h) const { return start(previous(h)); }
  /// The same edge in the neighbouring triangle; -1 on a border.
  int twin(int h) const { return twin_[h]; }
  /// A half-edge that starts at v; at a border the one that lies on it.
  int outgoing(int v) const { return outgoing_[v]; }
  /// The next half-edge that starts where h does, counter-clockwise; -1 past a border.
  int turn(int h) const { return twin(previous(h)); }
  bool is_border_vertex(int v) const { return twin(outgoing(v)) < 0; }
  /// Number of edges at v.
  int valence(int v) const;

  const Vec3& position(int v) const { return position_[v]; }
  void set_position(int v, const Vec3& p) { position_[v] = p; }

  /// Puts a new vertex at p on the edge; returns it.
  int split(int h, const Vec3& p);

  /// Whether collapse(h) is legal: start(h) inside, link condition, no vertex left with fewer than
  /// three edges (two at a border).
  bool can_collapse(int h) const;
  /// Removes start(h): its triangles go to end(h), but for the two at the edge, which vanish.
  /// Returns false and changes nothing if not legal.
  bool collapse(int h);

  /// Whether the edge can be turned within its two triangles: inside, the new edge doesn't exist
  /// yet, and no vertex is left with fewer than three edges.
  bool can_flip(int h) const;
  /// The edge a b of triangles a b c and b a d becomes c d. Returns false and changes nothing if
  /// not legal.
  bool flip(int h);

  struct Compacted {
    TriangleMesh mesh;
    std::vector<int> old_of_new;  ///< per vertex
  };
  /// The mesh without what was removed; order kept.
  Compacted compacted() const;

 private:
  bool is_neighbour(int a, int b) const;
  int add_triangle(int a, int b, int c);
  void link(int h, int g);
  void settle_outgoing(int v, int h);

  std::vector<Vec3> position_;
  std::vector<int> start_, twin_, outgoing_;
};

}  // namespace palmar::geometry
