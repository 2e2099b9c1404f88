// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/remesh/split_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <sstream>
#include <utility>
#include <vector>

#include "palmar/core/error.h"

namespace palmar::geometry {
namespace {

// A round shortens the longest edge of a triangle to 0.87 of it at most (the median of an
// equilateral one), usually to a half: enough from 10 m down to 0.1 mm.
constexpr int kMostSplits = 80;

using Edge = std::pair<int, int>;

Edge edge_between(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// Splits a triangle at the midpoints (-1: none) of its edges 01, 12, 20.
void split_triangle(const Triangle& t, const std::array<int, 3>& middle,
                    std::vector<Triangle>& triangles) {
  const int count =
      static_cast<int>(std::count_if(middle.begin(), middle.end(), [](int m) { return m >= 0; }));
  if (count == 0) {
    triangles.push_back(t);
    return;
  }
  if (count == 3) {
    triangles.push_back({t[0], middle[0], middle[2]});
    triangles.push_back({middle[0], t[1], middle[1]});
    triangles.push_back({middle[2], middle[1], t[2]});
    triangles.push_back(middle);
    return;
  }
  for (int k = 0; k < 3; ++k) {
    const int a = t[k];
    const int b = t[(k + 1) % 3];
    const int c = t[(k + 2) % 3];
    const int ab = middle[k];
    const int bc = middle[(k + 1) % 3];
    if (count == 1 && ab >= 0) {
      triangles.push_back({a, ab, c});
      triangles.push_back({ab, b, c});
    }
    if (count == 2 && ab >= 0 && bc >= 0) {
      triangles.push_back({ab, b, bc});
      triangles.push_back({a, ab, bc});
      triangles.push_back({a, bc, c});
    }
  }
}

/// Edges to split in this round, ascending.
std::vector<Edge> long_edges(const TriangleMesh& mesh, double edge_length,
                             const TriangleChoice& where) {
  std::vector<Edge> marked;
  for (const Triangle& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[t[0]];
    const Vec3& b = mesh.vertices[t[1]];
    const Vec3& c = mesh.vertices[t[2]];
    const double longest =
        std::sqrt(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
    if (!(longest > edge_length) || (where && !where(a, b, c))) continue;
    const double limit = std::max(edge_length, 0.6 * longest);
    for (int k = 0; k < 3; ++k) {
      const int i = t[k];
      const int j = t[(k + 1) % 3];
      if ((mesh.vertices[i] - mesh.vertices[j]).norm() > limit)
        marked.push_back(edge_between(i, j));
    }
  }
  std::sort(marked.begin(), marked.end());
  marked.erase(std::unique(marked.begin(), marked.end()), marked.end());
  return marked;
}

void check(const TriangleMesh& mesh, double edge_length) {
  if (!(edge_length >= 0.1 && edge_length <= 1000.0)) {
    std::ostringstream message;
    message << "split edges: edge length is " << edge_length << " mm; 0.1 to 1000 mm is required";
    throw UsageError(message.str());
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const int v : mesh.triangles[i]) {
      if (v >= 0 && v < mesh.vertex_count()) continue;
      std::ostringstream message;
      message << "split edges: triangle " << i << " names vertex " << v << " of "
              << mesh.vertex_count();
      throw InputError(message.str());
    }
  }
}

}  // namespace

SplitMesh split_with_parents(const TriangleMesh& mesh, double edge_length,
                             const TriangleChoice& where) {
  check(mesh, edge_length);
  SplitMesh split{mesh, std::vector<int>(mesh.triangles.size())};
  std::iota(split.parent.begin(), split.parent.end(), 0);
  TriangleMesh& result = split.mesh;
  for (int round = 0; round < kMostSplits; ++round) {
    const std::vector<Edge> marked = long_edges(result, edge_length, where);
    if (marked.empty()) break;
    const int first_middle = result.vertex_count();
    for (const auto& [i, j] : marked) {
      result.vertices.push_back(0.5 * (result.vertices[i] + result.vertices[j]));
    }
    std::vector<Triangle> triangles;
    triangles.reserve(result.triangles.size() + 2 * marked.size());
    std::vector<int> parent;
    parent.reserve(triangles.capacity());
    for (std::size_t i = 0; i < result.triangles.size(); ++i) {
      const Triangle& t = result.triangles[i];
      std::array<int, 3> middle = {-1, -1, -1};
      for (int k = 0; k < 3; ++k) {
        const Edge edge = edge_between(t[k], t[(k + 1) % 3]);
        const auto found = std::lower_bound(marked.begin(), marked.end(), edge);
        if (found != marked.end() && *found == edge) {
          middle[k] = first_middle + static_cast<int>(found - marked.begin());
        }
      }
      split_triangle(t, middle, triangles);
      parent.resize(triangles.size(), split.parent[i]);
    }
    result.triangles = std::move(triangles);
    split.parent = std::move(parent);
  }
  return split;
}

TriangleMesh split_long_edges(const TriangleMesh& mesh, double edge_length,
                              const TriangleChoice& where) {
  return split_with_parents(mesh, edge_length, where).mesh;
}

}  // namespace palmar::geometry
