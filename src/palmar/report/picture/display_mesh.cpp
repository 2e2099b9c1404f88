// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/picture/display_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "palmar/report/words/plain_words.h"

namespace palmar::report {

namespace {

DisplayMesh clustered(const geometry::TriangleMesh& mesh, const std::vector<double>& value,
                      const Box3& box, double cell) {
  DisplayMesh coarse;
  std::map<std::array<int, 3>, int> joint_of;
  std::vector<int> joint(mesh.vertices.size());
  std::vector<int> count;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3 at = (mesh.vertices[v] - box.min()) / cell;
    const std::array<int, 3> key{static_cast<int>(at.x()), static_cast<int>(at.y()),
                                 static_cast<int>(at.z())};
    const auto [entry, is_new] = joint_of.try_emplace(key, static_cast<int>(count.size()));
    joint[v] = entry->second;
    const auto j = static_cast<std::size_t>(entry->second);
    if (is_new) {
      coarse.mesh.vertices.push_back(Vec3::Zero());
      coarse.value.push_back(value[v]);
      count.push_back(0);
    }
    coarse.mesh.vertices[j] += mesh.vertices[v];
    coarse.value[j] = std::max(coarse.value[j], value[v]);
    ++count[j];
  }
  for (std::size_t j = 0; j < count.size(); ++j) coarse.mesh.vertices[j] /= count[j];
  for (const Triangle& t : mesh.triangles) {
    const int a = joint[static_cast<std::size_t>(t[0])];
    const int b = joint[static_cast<std::size_t>(t[1])];
    const int c = joint[static_cast<std::size_t>(t[2])];
    if (a != b && b != c && c != a) coarse.mesh.triangles.push_back({a, b, c});
  }
  return coarse;
}

}  // namespace

DisplayMesh display_mesh(const geometry::TriangleMesh& mesh, const std::vector<double>& value,
                         int most_triangles) {
  DisplayMesh result{mesh, value};
  if (mesh.triangle_count() <= most_triangles) return result;
  Box3 box;
  for (const Vec3& v : mesh.vertices) box.extend(v);
  // About one triangle pair per cell of the surface: the first guess is mostly right.
  double cell = box.diagonal().norm() / std::sqrt(most_triangles);
  while (result.mesh.triangle_count() > most_triangles && cell > 0.0) {
    result = clustered(mesh, value, box, cell);
    cell *= 1.25;
  }
  return result;
}

std::string json_triple(const Vec3& point) {
  return "[" + exact_number(point.x()) + "," + exact_number(point.y()) + "," +
         exact_number(point.z()) + "]";
}

std::string json_triple(Rgb colour) {
  return "[" + std::to_string(colour.r) + "," + std::to_string(colour.g) + "," +
         std::to_string(colour.b) + "]";
}

}  // namespace palmar::report
