// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/assessment/face_contacts.h"

#include <algorithm>
#include <numeric>
#include <string>

#include "palmar/core/error.h"

namespace palmar::study {

FaceAreas::FaceAreas(const geometry::TriangleMesh& map, const std::vector<int>& face_of_triangle)
    : start_(map.vertices.size() + 1, 0), triangle_(map.triangles), face_(face_of_triangle) {
  if (face_.size() != triangle_.size()) {
    throw UsageError("faces: " + std::to_string(face_.size()) +
                     " triangles have a face; the map has " + std::to_string(triangle_.size()));
  }
  for (const int face : face_) {
    if (face < 0) throw UsageError("faces: a triangle of the map has no face");
    faces_ = std::max(faces_, face + 1);
  }
  for (const Triangle& t : triangle_) {
    for (const int v : t) ++start_[v + 1];
    third_.push_back((map.vertices[t[1]] - map.vertices[t[0]])
                         .cross(map.vertices[t[2]] - map.vertices[t[0]])
                         .norm() /
                     6.0);
  }
  for (std::size_t v = 1; v < start_.size(); ++v) start_[v] += start_[v - 1];
  std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
  corner_.resize(3 * triangle_.size());
  for (std::size_t t = 0; t < triangle_.size(); ++t) {
    for (const int v : triangle_[t]) {
      corner_[next[v]++] = {static_cast<int>(t), face_[t], third_[t]};
    }
  }
}

/// Of the faces that meet at a vertex, that with the highest mean pressure over its triangles
/// there.
int FaceAreas::peak_face(const std::vector<double>& pressure, int vertex) const {
  struct Around {
    int face = 0;
    double force = 0.0, area = 0.0;
  };
  std::vector<Around> around;
  for (std::size_t k = start_[vertex]; k < start_[vertex + 1]; ++k) {
    const int t = corner_[k].triangle;
    auto one = std::find_if(around.begin(), around.end(),
                            [&](const Around& other) { return other.face == face_[t]; });
    if (one == around.end()) one = around.insert(around.end(), {face_[t]});
    for (const int v : triangle_[t]) one->force += third_[t] * pressure[v];
    one->area += 3.0 * third_[t];
  }
  int best = -1;
  double highest = -1.0;
  for (const Around& one : around) {
    const double mean = one.area > 0.0 ? one.force / one.area : 0.0;
    if (mean > highest || (mean == highest && one.face < best)) {
      highest = mean;
      best = one.face;
    }
  }
  return best;
}

std::vector<FaceContact> FaceAreas::contacts(const std::vector<double>& pressure) const {
  std::vector<int> all(pressure.size());
  std::iota(all.begin(), all.end(), 0);
  return contacts(pressure, all);
}

std::vector<FaceContact> FaceAreas::contacts(const std::vector<double>& pressure,
                                             std::span<const int> loaded) const {
  if (pressure.size() != vertex_count()) {
    throw UsageError("faces: " + std::to_string(pressure.size()) + " pressures for a map of " +
                     std::to_string(vertex_count()) + " vertices");
  }
  std::vector<FaceContact> all(faces_);
  int peak_vertex = 0;
  double peak = 0.0;
  for (const int vertex : loaded) {
    const double p = pressure[vertex];
    if (!(p > 0.0)) continue;
    if (p > peak) {
      peak = p;
      peak_vertex = vertex;
    }
    for (std::size_t k = start_[vertex]; k < start_[vertex + 1]; ++k) {
      FaceContact& one = all[corner_[k].face];
      one.force += corner_[k].third * p;
      one.area += corner_[k].third;
      one.peak_pressure = std::max(one.peak_pressure, p);
    }
  }
  if (peak > 0.0) {
    const int face = peak_face(pressure, peak_vertex);
    if (face >= 0) all[face].has_peak = true;
  }
  std::vector<FaceContact> touched;
  for (int f = 0; f < faces_; ++f) {
    FaceContact one = all[f];
    if (!(one.area > 0.0)) continue;
    one.face = f;
    one.mean_pressure = one.force / one.area;
    touched.push_back(one);
  }
  return touched;
}

std::vector<FaceContact> face_contacts(const contact::ProductFootprint& footprint,
                                       const product::Product& product) {
  if (product.faces == nullptr || footprint.surface.triangles.empty()) return {};
  std::vector<int> face_of_triangle;
  face_of_triangle.reserve(footprint.parent.size());
  for (const int parent : footprint.parent) {
    face_of_triangle.push_back(product.faces->face_of_triangle[parent]);
  }
  return FaceAreas(footprint.surface, face_of_triangle).contacts(footprint.pressure);
}

}  // namespace palmar::study
