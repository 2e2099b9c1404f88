// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/mesh/boundary_loops.h"

#include <algorithm>

namespace palmar::geometry {
namespace {

/// Free half-edges of a mesh, turned round: from each corner to where the hole's rim goes on.
class Rim {
 public:
  Rim(const TriangleMesh& mesh, const MeshTopology& topology) {
    begin_.assign(static_cast<std::size_t>(mesh.vertex_count()) + 1, 0);
    std::vector<std::array<int, 2>> steps;
    for (int h = 0; h < static_cast<int>(topology.edge_of.size()); ++h) {
      const int edge = topology.edge_of[h];
      if (edge < 0 || topology.edge_use[edge] != 1) continue;
      const int from = mesh.triangles[h / 3][h % 3];
      const int to = mesh.triangles[h / 3][MeshTopology::next(h) % 3];
      steps.push_back({to, from});
    }
    std::sort(steps.begin(), steps.end());
    for (const auto& step : steps) {
      ++begin_[step[0] + 1];
      to_.push_back(step[1]);
    }
    for (std::size_t v = 1; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
    taken_ = std::vector<int>(begin_.begin(), begin_.end() - 1);
  }
  int count() const { return static_cast<int>(to_.size()); }
  int vertex_count() const { return static_cast<int>(taken_.size()); }
  /// The next corner after `vertex` on a way not yet gone; -1: none.
  int leave(int vertex) {
    int& at = taken_[vertex];
    return at < begin_[vertex + 1] ? to_[at++] : -1;
  }

 private:
  std::vector<int> begin_, to_, taken_;
};

}  // namespace

BoundaryLoops find_boundary_loops(const TriangleMesh& mesh, const MeshTopology& topology) {
  BoundaryLoops result;
  Rim rim(mesh, topology);
  std::vector<int> place(mesh.vertex_count(),
                         -1);  // on the way, if on it
  int used = 0;
  for (int seed = 0; seed < rim.vertex_count(); ++seed) {
    for (int first = rim.leave(seed); first >= 0; first = rim.leave(seed)) {
      // Walk on; whenever the way meets itself, the ring between is cut off.
      std::vector<int> way = {seed};
      place[seed] = 0;
      for (int v = first; v >= 0; v = rim.leave(v)) {
        if (place[v] < 0) {
          place[v] = static_cast<int>(way.size());
          way.push_back(v);
          continue;
        }
        BoundaryLoop loop;
        loop.corner.assign(way.begin() + place[v], way.end());
        for (const int corner : loop.corner) place[corner] = -1;
        way.resize(way.size() - loop.corner.size() + 1);
        used += loop.size();
        place[v] = static_cast<int>(way.size()) - 1;
        if (loop.size() >= 3) {
          result.loops.push_back(std::move(loop));
        } else {
          used -= loop.size();  // two triangles that agree about nothing
        }
      }
      for (const int v : way) place[v] = -1;
    }
  }
  result.loose_edges = rim.count() - used;
  for (BoundaryLoop& loop : result.loops) {
    for (int i = 0; i < loop.size(); ++i) {
      const Vec3& a = mesh.vertices[loop.corner[i]];
      const Vec3& b = mesh.vertices[loop.corner[(i + 1) % loop.size()]];
      const double length = (b - a).norm();
      loop.perimeter += length;
      loop.centre += length * (a + b) / 2.0;
    }
    loop.centre = loop.perimeter > 0.0 ? Vec3(loop.centre / loop.perimeter)
                                       : mesh.vertices[loop.corner.front()];
  }
  std::stable_sort(result.loops.begin(), result.loops.end(), [](const auto& a, const auto& b) {
    return *std::min_element(a.corner.begin(), a.corner.end()) <
           *std::min_element(b.corner.begin(), b.corner.end());
  });
  return result;
}

}  // namespace palmar::geometry
