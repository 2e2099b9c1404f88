// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/tetra/tetrahedral_lattice.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <unordered_set>

#include "palmar/core/error.h"

namespace palmar::geometry {
namespace {

/// A place in units of half the smallest cube's edge.
using LatticePlace = std::array<int, 3>;

std::uint64_t key_of(const LatticePlace& p) {
  constexpr int kOffset = 1 << 10;  // places may lie a little below 0
  return (static_cast<std::uint64_t>(p[0] + kOffset) << 42) |
         (static_cast<std::uint64_t>(p[1] + kOffset) << 21) |
         static_cast<std::uint64_t>(p[2] + kOffset);
}

/// Cubes are known by their level and their lowest corner.
class Octree {
 public:
  Octree(const Box3& box, const LatticeOptions& options) : box_(box), options_(options) {
    cubes_.resize(options.levels);
    const int size = size_of(0);
    LatticePlace count{};
    for (int k = 0; k < 3; ++k) {
      count[k] = std::max(1, static_cast<int>(std::ceil(box.sizes()[k] / options.edge - 1e-9)));
    }
    for (int x = 0; x < count[0]; ++x) {
      for (int y = 0; y < count[1]; ++y) {
        for (int z = 0; z < count[2]; ++z) add(0, {x * size, y * size, z * size});
      }
    }
    for (int level = 0; level + 1 < options.levels; ++level) split_level(level);
    // Balance, from the smallest cubes upwards.
    for (int level = options.levels - 1; level > 1; --level) balance(level);
  }

  int levels() const { return options_.levels; }
  int size_of(int level) const { return 2 << (options_.levels - 1 - level); }
  const std::vector<LatticePlace>& cubes(int level) const { return cubes_[level].list; }
  bool is_leaf(int level, const LatticePlace& corner) const {
    if (level < 0 || level >= levels()) return false;
    const auto found = cubes_[level].state.find(key_of(corner));
    return found != cubes_[level].state.end() && found->second;
  }
  Vec3 point(const LatticePlace& p) const {
    return box_.min() + 0.5 * options_.edge / (1 << (options_.levels - 1)) * Vec3(p[0], p[1], p[2]);
  }
  LatticeCube cube(int level, const LatticePlace& corner) const {
    const int half = size_of(level) / 2;
    return {point({corner[0] + half, corner[1] + half, corner[2] + half}),
            options_.edge / (1 << level)};
  }

 private:
  struct Level {
    std::vector<LatticePlace> list;                 // in the order they came
    std::unordered_map<std::uint64_t, char> state;  // 1: leaf, 0: split
  };

  void add(int level, const LatticePlace& corner) {
    if (cubes_[level].state.try_emplace(key_of(corner), 1).second) {
      cubes_[level].list.push_back(corner);
    }
  }
  void split(int level, const LatticePlace& corner) {
    cubes_[level].state[key_of(corner)] = 0;
    const int half = size_of(level + 1);
    for (int k = 0; k < 8; ++k) {
      add(level + 1, {corner[0] + (k & 1) * half, corner[1] + (k >> 1 & 1) * half,
                      corner[2] + (k >> 2) * half});
    }
  }
  void split_level(int level) {
    if (!options_.is_split) return;
    for (std::size_t k = 0; k < cubes_[level].list.size(); ++k) {
      const LatticePlace corner = cubes_[level].list[k];
      if (is_leaf(level, corner) && options_.is_split(cube(level, corner))) split(level, corner);
    }
  }
  /// No cube two sizes larger than one of this level touches it.
  void balance(int level) {
    const int size = size_of(level);
    const int large = size_of(level - 2);
    for (std::size_t k = 0; k < cubes_[level].list.size(); ++k) {
      const LatticePlace c = cubes_[level].list[k];
      for (int n = 0; n < 27; ++n) {
        LatticePlace at{};
        const LatticePlace step{n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
        for (int a = 0; a < 3; ++a) {
          const int middle = c[a] + step[a] * size;
          at[a] = static_cast<int>(std::floor(static_cast<double>(middle) / large)) * large;
        }
        if (is_leaf(level - 2, at)) split(level - 2, at);
      }
    }
  }

  Box3 box_;
  const LatticeOptions& options_;
  std::vector<Level> cubes_;
};

class LatticeBuilder {
 public:
  LatticeBuilder(const Octree& tree, const LatticeOptions& options)
      : tree_(tree), options_(options) {}

  TetrahedralMesh run() {
    for (int level = 0; level < tree_.levels(); ++level) {
      const int size = tree_.size_of(level);
      for (const LatticePlace& c : tree_.cubes(level)) {
        if (!tree_.is_leaf(level, c)) continue;
        for (int k = 0; k < 8; ++k) {
          corners_.insert(
              key_of({c[0] + (k & 1) * size, c[1] + (k >> 1 & 1) * size, c[2] + (k >> 2) * size}));
        }
      }
    }
    for (int level = 0; level < tree_.levels(); ++level) {
      for (const LatticePlace& c : tree_.cubes(level)) {
        if (!tree_.is_leaf(level, c) || !is_wanted(level, c)) continue;
        for (int axis = 0; axis < 3; ++axis) {
          add_face(level, c, axis, -1);
          add_face(level, c, axis, 1);
        }
      }
    }
    return std::move(mesh_);
  }

 private:
  bool is_wanted(int level, const LatticePlace& c) {
    if (!options_.is_wanted) return true;
    const auto [place, is_new] = wanted_[level].try_emplace(key_of(c), 0);
    if (is_new) place->second = options_.is_wanted(tree_.cube(level, c)) ? 1 : 0;
    return place->second != 0;
  }
  int vertex(const LatticePlace& p) {
    const auto [place, is_new] = vertex_.try_emplace(key_of(p), mesh_.vertex_count());
    if (is_new) mesh_.vertices.push_back(tree_.point(p));
    return place->second;
  }
  int centre(int level, const LatticePlace& c) {
    const int half = tree_.size_of(level) / 2;
    return vertex({c[0] + half, c[1] + half, c[2] + half});
  }
  void add(int a, int b, int c, int d) {
    const auto& x = mesh_.vertices;
    const bool is_right = tetrahedron_volume(x[a], x[b], x[c], x[d]) > 0.0;
    mesh_.tetrahedra.push_back(is_right ? Tetrahedron{a, b, c, d} : Tetrahedron{a, b, d, c});
  }
  // vertex() makes vertices, and compilers differ in the order in which they evaluate arguments: it
  // is said here, so that all number them alike.
  void add_corners(const LatticePlace& p, const LatticePlace& q, const LatticePlace& r, int apex) {
    const int c = vertex(r), b = vertex(q), a = vertex(p);
    add(a, b, c, apex);
  }
  void add_edge(int own, int opposite, const LatticePlace& p, const LatticePlace& q) {
    const int d = vertex(q), c = vertex(p);
    add(own, opposite, c, d);
  }

  void add_face(int level, const LatticePlace& c, int axis, int side) {
    const int size = tree_.size_of(level);
    LatticePlace other = c;
    other[axis] += side * size;
    int other_level = level;
    if (tree_.is_leaf(level, other)) {
      if (side < 0) return;  // seen from the other cube
    } else {
      other_level = level - 1;
      if (other_level < 0) return;
      const int large = tree_.size_of(other_level);
      for (int& v : other) v = static_cast<int>(std::floor(static_cast<double>(v) / large)) * large;
      if (!tree_.is_leaf(other_level, other)) return;  // smaller ones there, or nothing
    }
    if (!is_wanted(other_level, other)) return;
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    std::array<LatticePlace, 4> corner;
    corner.fill(c);
    for (LatticePlace& p : corner) p[axis] += side > 0 ? size : 0;
    corner[1][u] += size;
    corner[2][u] += size;
    corner[2][v] += size;
    corner[3][v] += size;
    const int own = centre(level, c);
    const int opposite = centre(other_level, other);
    if (other_level != level) {
      for (const int apex : {own, opposite}) {
        add_corners(corner[0], corner[1], corner[2], apex);
        add_corners(corner[0], corner[2], corner[3], apex);
      }
      return;
    }
    for (std::size_t k = 0; k < 4; ++k) {
      const LatticePlace& p = corner[k];
      const LatticePlace& q = corner[(k + 1) % 4];
      const LatticePlace middle{(p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2};
      if (corners_.contains(key_of(middle))) {
        add_edge(own, opposite, p, middle);
        add_edge(own, opposite, middle, q);
      } else {
        add_edge(own, opposite, p, q);
      }
    }
  }

  const Octree& tree_;
  const LatticeOptions& options_;
  TetrahedralMesh mesh_;
  std::unordered_map<std::uint64_t, int> vertex_;
  std::unordered_set<std::uint64_t> corners_;
  std::array<std::unordered_map<std::uint64_t, char>, 6> wanted_;
};

}  // namespace

void LatticeOptions::check() const {
  if (!(edge > 0.0 && std::isfinite(edge))) {
    throw UsageError("lattice: edge is " + std::to_string(edge) + " mm; above 0 is required");
  }
  if (levels < 1 || levels > 6) {
    throw UsageError("lattice: levels is " + std::to_string(levels) + "; 1 to 6 is required");
  }
}

TetrahedralMesh make_tetrahedral_lattice(const Box3& box, const LatticeOptions& options) {
  options.check();
  if (box.isEmpty()) return {};
  const Octree tree(box, options);
  return LatticeBuilder(tree, options).run();
}

}  // namespace palmar::geometry
