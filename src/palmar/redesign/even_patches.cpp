// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/even_patches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/disjoint_sets.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/remesh/remesh.h"

namespace palmar::redesign {
namespace {

constexpr double kCrease = 0.766;  // cosine of 40 degrees: facets of a small fillet turn by 26
constexpr int kRounds = 8;

/// Triangles of one group that are joined across edges that aren't creases. Corners that meet only
/// in a point, or across a crease, are different ones: `corner_of` says which, by 3 triangle + k.
struct Patches {
  std::vector<std::vector<int>> triangles;
  std::vector<int> corner_of;
};
Patches patches_of(const geometry::TriangleMesh& mesh, const std::vector<int>& group) {
  const std::vector<Vec3> normal = geometry::triangle_normals(mesh);
  struct Side {
    std::pair<int, int> edge;
    int triangle, from;  ///< its first corner
  };
  std::vector<Side> sides;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    if (group[t] < 0) continue;
    const Triangle& corner = mesh.triangles[t];
    for (int k = 0; k < 3; ++k) {
      sides.push_back({std::minmax(corner[k], corner[(k + 1) % 3]), t, k});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::pair(a.edge, a.triangle) < std::pair(b.edge, b.triangle);
  });
  geometry::DisjointSets patches(mesh.triangle_count()), corners(3 * mesh.triangle_count());
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].edge == sides[i].edge) ++end;
    if (end == i + 2) {
      const Side &a = sides[i], &b = sides[i + 1];
      if (group[a.triangle] == group[b.triangle] &&
          normal[a.triangle].dot(normal[b.triangle]) > kCrease) {
        patches.unite(a.triangle, b.triangle);
        for (const int k : {a.from, (a.from + 1) % 3}) {
          for (const int m : {b.from, (b.from + 1) % 3}) {
            if (mesh.triangles[a.triangle][k] == mesh.triangles[b.triangle][m]) {
              corners.unite(3 * a.triangle + k, 3 * b.triangle + m);
            }
          }
        }
      }
    }
    i = end;
  }
  Patches result;
  std::map<int, std::vector<int>> by_root;
  result.corner_of.assign(3 * mesh.triangles.size(), -1);
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    if (group[t] < 0) continue;
    by_root[patches.root(t)].push_back(t);
    for (int k = 0; k < 3; ++k) result.corner_of[3 * t + k] = corners.root(3 * t + k);
  }
  for (auto& [first, patch] : by_root) result.triangles.push_back(std::move(patch));
  return result;
}

/// A patch made anew, and for each of its vertices the one of the whole mesh that it is; -1: new.
struct EvenPatch {
  geometry::TriangleMesh mesh;
  std::vector<int> known;
};
std::optional<EvenPatch> even_patch(const geometry::TriangleMesh& whole,
                                    const std::vector<int>& triangles,
                                    const std::vector<int>& corner_of, double edge_length) {
  geometry::TriangleMesh part;
  std::map<int, int> place;  // corner -> vertex of the part
  std::vector<int> of_whole;
  for (const int t : triangles) {
    Triangle corner = whole.triangles[t];
    for (int k = 0; k < 3; ++k) {
      const auto [at, is_new] = place.emplace(corner_of[3 * t + k], part.vertex_count());
      if (is_new) {
        part.vertices.push_back(whole.vertices[corner[k]]);
        of_whole.push_back(corner[k]);
      }
      corner[k] = at->second;
    }
    part.triangles.push_back(corner);
  }
  EvenPatch even;
  try {
    // Edges come out up to 4/3 of what is wanted.
    even.mesh = geometry::remesh(part, {.edge_length = 0.75 * edge_length, .rounds = kRounds}).mesh;
  } catch (const InputError&) {
    return std::nullopt;  // not 2-manifold
  }
  const auto border_of = [](const geometry::TriangleMesh& mesh) {
    std::map<std::pair<int, int>, int> uses;
    for (const Triangle& corner : mesh.triangles) {
      for (int k = 0; k < 3; ++k) ++uses[std::minmax(corner[k], corner[(k + 1) % 3])];
    }
    std::vector<char> is_border(mesh.vertices.size(), 0);
    for (const auto& [edge, count] : uses) {
      if (count == 1) is_border[edge.first] = is_border[edge.second] = 1;
    }
    return is_border;
  };
  const auto key = [](const Vec3& x) { return std::array{x.x(), x.y(), x.z()}; };
  std::map<std::array<double, 3>, int> border;  // where -> vertex of the whole mesh
  const std::vector<char> was_border = border_of(part), is_border = border_of(even.mesh);
  for (int v = 0; v < part.vertex_count(); ++v) {
    if (!was_border[v]) continue;
    const auto [at, is_new] = border.emplace(key(part.vertices[v]), of_whole[v]);
    if (at->second != of_whole[v]) return std::nullopt;  // can't be told apart afterwards
  }
  even.known.assign(even.mesh.vertices.size(), -1);
  for (int v = 0; v < even.mesh.vertex_count(); ++v) {
    if (!is_border[v]) continue;
    const auto at = border.find(key(even.mesh.vertices[v]));
    if (at == border.end()) return std::nullopt;  // an edge of the border was split
    even.known[v] = at->second;
  }
  return even;
}

}  // namespace

geometry::TriangleMesh with_even_patches(const geometry::TriangleMesh& mesh,
                                         const std::vector<int>& group, double edge_length) {
  geometry::TriangleMesh result;
  std::vector<int> place(mesh.vertices.size(), -1);
  const auto kept = [&](int v) {
    if (place[v] < 0) {
      place[v] = result.vertex_count();
      result.vertices.push_back(mesh.vertices[v]);
    }
    return place[v];
  };
  const auto keep = [&](int t) {
    const Triangle& corner = mesh.triangles[t];
    result.triangles.push_back({kept(corner[0]), kept(corner[1]), kept(corner[2])});
  };
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    if (group[t] < 0) keep(t);
  }
  const Patches patches = patches_of(mesh, group);
  for (const std::vector<int>& patch : patches.triangles) {
    const std::optional<EvenPatch> even = even_patch(mesh, patch, patches.corner_of, edge_length);
    if (!even) {
      for (const int t : patch) keep(t);
      continue;
    }
    std::vector<int> at(even->mesh.vertices.size());
    for (int v = 0; v < even->mesh.vertex_count(); ++v) {
      if (even->known[v] >= 0) {
        at[v] = kept(even->known[v]);
      } else {
        at[v] = result.vertex_count();
        result.vertices.push_back(even->mesh.vertices[v]);
      }
    }
    for (const Triangle& corner : even->mesh.triangles) {
      result.triangles.push_back({at[corner[0]], at[corner[1]], at[corner[2]]});
    }
  }
  return result;
}

}  // namespace palmar::redesign
