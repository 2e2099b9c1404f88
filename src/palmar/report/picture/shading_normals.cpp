// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/picture/shading_normals.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace palmar::report {

namespace {

// For each vertex the first one that stands at the same place.
std::vector<int> places_of(const geometry::TriangleMesh& mesh) {
  std::vector<int> order(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int v) {
    const Vec3& x = mesh.vertices[static_cast<std::size_t>(v)];
    return std::tuple(x.x(), x.y(), x.z(), v);
  };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  std::vector<int> place(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto v = static_cast<std::size_t>(order[i]);
    const bool is_same =
        i > 0 && mesh.vertices[v] == mesh.vertices[static_cast<std::size_t>(order[i - 1])];
    place[v] = is_same ? place[static_cast<std::size_t>(order[i - 1])] : order[i];
  }
  return place;
}

struct Corner {
  int triangle = 0;
  double angle = 0.0;  // rad
};

}  // namespace

std::vector<std::array<Vec3, 3>> shading_normals(const geometry::TriangleMesh& mesh,
                                                 double crease_angle) {
  const std::vector<int> place = places_of(mesh);
  std::vector<Vec3> face(mesh.triangles.size(), Vec3::UnitZ());
  std::vector<std::vector<Corner>> fan(mesh.vertices.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<Vec3, 3> x;
    for (std::size_t k = 0; k < 3; ++k) {
      x[k] = mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][k])];
    }
    const Vec3 normal = (x[1] - x[0]).cross(x[2] - x[0]);
    if (!(normal.norm() > 0.0)) continue;
    face[t] = normal.normalized();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 a = x[(k + 1) % 3] - x[k];
      const Vec3 b = x[(k + 2) % 3] - x[k];
      const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
      const auto vertex = static_cast<std::size_t>(mesh.triangles[t][k]);
      fan[static_cast<std::size_t>(place[vertex])].push_back({static_cast<int>(t), angle});
    }
  }
  const double least_cosine = std::cos(crease_angle);
  std::vector<std::array<Vec3, 3>> normals(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto vertex = static_cast<std::size_t>(mesh.triangles[t][k]);
      Vec3 sum = Vec3::Zero();
      for (const Corner& c : fan[static_cast<std::size_t>(place[vertex])]) {
        const Vec3& other = face[static_cast<std::size_t>(c.triangle)];
        if (other.dot(face[t]) >= least_cosine) sum += c.angle * other;
      }
      normals[t][k] = sum.norm() > 1e-9 ? Vec3(sum.normalized()) : face[t];
    }
  }
  return normals;
}

}  // namespace palmar::report
