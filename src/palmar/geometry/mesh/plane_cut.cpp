// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/mesh/plane_cut.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "palmar/core/error.h"

namespace palmar::geometry {
namespace {

/// The cut while it is made: vertices of the result by where they come from.
class PlaneCutter {
 public:
  PlaneCutter(const TriangleMesh& closed, const Vec3& point, const Vec3& normal, double snap)
      : closed_(closed), position_(closed.vertices), kept_(closed.vertices.size(), -1) {
    height_.reserve(position_.size());
    for (Vec3& v : position_) {
      double h = (v - point).dot(normal);
      if (std::abs(h) <= snap) {
        v -= h * normal;
        h = 0.0;
      }
      height_.push_back(h);
    }
  }

  CutMesh run() {
    for (int t = 0; t < closed_.triangle_count(); ++t) cut(t);
    collect_rim();
    return std::move(result_);
  }

 private:
  double height(int v) const { return height_[v]; }

  int keep(int v) {
    int& index = kept_[v];
    if (index < 0) index = add(position_[v], height(v) == 0.0);
    return index;
  }

  /// Where the edge from a to b, on either side of the plane, meets it.
  int crossing(int a, int b) {
    const auto key = std::minmax(a, b);
    const auto [entry, is_new] = crossing_.try_emplace({key.first, key.second}, -1);
    if (is_new) {
      const double share = height(key.first) / (height(key.first) - height(key.second));
      const Vec3& from = position_[key.first];
      entry->second = add(from + share * (position_[key.second] - from), true);
    }
    return entry->second;
  }

  int add(const Vec3& position, bool is_in_plane) {
    result_.mesh.vertices.push_back(position);
    is_in_plane_.push_back(is_in_plane);
    return result_.mesh.vertex_count() - 1;
  }

  void cut(int t) {
    const Triangle& corner = closed_.triangles[t];
    if (std::none_of(corner.begin(), corner.end(), [&](int v) { return height(v) > 0.0; })) return;
    std::vector<int> polygon;
    for (int k = 0; k < 3; ++k) {
      const int a = corner[k];
      const int b = corner[(k + 1) % 3];
      if (height(a) >= 0.0) polygon.push_back(keep(a));
      if (height(a) * height(b) < 0.0) polygon.push_back(crossing(a, b));
    }
    if (polygon.size() == 4 && (at(polygon[0]) - at(polygon[2])).squaredNorm() >
                                   (at(polygon[1]) - at(polygon[3])).squaredNorm()) {
      std::rotate(polygon.begin(), polygon.begin() + 1, polygon.end());
    }
    for (std::size_t k = 2; k < polygon.size(); ++k) {
      result_.mesh.triangles.push_back({polygon[0], polygon[k - 1], polygon[k]});
      result_.triangle_of.push_back(t);
    }
  }

  const Vec3& at(int v) const { return result_.mesh.vertices[v]; }

  /// Edges in the plane that no kept triangle runs the other way.
  void collect_rim() {
    std::map<std::pair<int, int>, int> in_plane;
    for (const Triangle& t : result_.mesh.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        const int a = t[k];
        const int b = t[(k + 1) % 3];
        if (is_in_plane_[a] && is_in_plane_[b]) {
          ++in_plane[{a, b}];
        }
      }
    }
    std::map<int, int> next;
    for (const auto& [edge, count] : in_plane) {
      if (in_plane.contains({edge.second, edge.first})) continue;
      if (!next.emplace(edge.first, edge.second).second) {
        throw InputError("cut by a plane: the rim touches itself; shift the plane a little");
      }
    }
    while (!next.empty()) {
      std::vector<int> loop;
      for (int v = next.begin()->first; next.contains(v);) {
        loop.push_back(v);
        const int to = next.at(v);
        next.erase(v);
        v = to;
      }
      result_.rim.push_back(std::move(loop));
    }
  }

  const TriangleMesh& closed_;
  std::vector<Vec3> position_;
  std::vector<double> height_;
  std::vector<int> kept_;
  std::map<std::pair<int, int>, int> crossing_;
  std::vector<bool> is_in_plane_;
  CutMesh result_;
};

}  // namespace

CutMesh cut_by_plane(const TriangleMesh& closed, const Vec3& point, const Vec3& normal,
                     double snap) {
  if (std::abs(normal.norm() - 1.0) > 1e-6) {
    throw UsageError("cut by a plane: the normal's length is " + std::to_string(normal.norm()) +
                     "; a unit vector is required");
  }
  if (!(snap >= 0.0)) {
    throw UsageError("cut by a plane: snap is " + std::to_string(snap) +
                     " mm; 0 or more is required");
  }
  return PlaneCutter(closed, point, normal, snap).run();
}

}  // namespace palmar::geometry
