// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::contact {

/// A posed skin whose triangles are divided into four where that is asked for, again and again; a
/// neighbour that is left with one halved edge is cut in two, so that the mesh stays closed (red
/// and green refinement; Bank, Sherman, Weiser 1983). Vertices keep their numbers; new ones follow.
///
/// A new vertex halves the cubic that has the positions and, across the normals, the directions of
/// its ends (the edge rule of PN triangles; Vlachos, Peters, Boyd, Mitchell 2001):
///
///     m = (a + b) / 2 + (((b - a) . n_b) n_b - ((b - a) . n_a) n_a) / 8
///
/// in the reference posture and as posed alike: facets of the skin don't press with their corners.
/// In creases, where normals differ by more than 60 degrees, it lies on the chord.
class SkinDivision {
 public:
  /// Positions [mm] at rest and as posed; `may_divide` per vertex: only triangles of three such
  /// vertices are divided.
  SkinDivision(std::vector<Triangle> triangles, std::vector<Vec3> at_rest, std::vector<Vec3> posed,
               std::vector<char> may_divide);

  /// Divides what touches a chosen vertex (per vertex), and what that leaves with two halved edges.
  void divide(const std::vector<char>& is_chosen);

  const std::vector<Triangle>& triangles() const { return triangles_; }  ///< closed
  const std::vector<Vec3>& at_rest() const { return shape_[0].position; }
  const std::vector<Vec3>& posed() const { return shape_[1].position; }
  std::size_t original_count() const { return original_; }
  /// The two vertices between which each new one was put, ascending in each pair.
  const std::vector<std::array<int, 2>>& ends() const { return ends_; }

  /// Shares of the original vertices in every vertex, which sum to 1.
  std::vector<std::vector<std::pair<int, double>>> shares() const;

 private:
  struct Shape {
    std::vector<Vec3> position, normal;
  };
  int middle(int a, int b);
  int known_middle(int a, int b) const;
  bool is_divisible(const Triangle& t) const;
  bool must_divide(const Triangle& t) const;
  void split(std::size_t leaf);
  void close();

  std::size_t original_ = 0;
  std::array<Shape, 2> shape_;
  std::vector<char> may_divide_;
  std::vector<Triangle> leaves_;  ///< undivided; edges may have vertices of smaller neighbours
  std::vector<Triangle> triangles_;
  std::vector<std::array<int, 2>> ends_;
  std::unordered_map<std::uint64_t, int> middle_;
};

}  // namespace palmar::contact
