// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/server/shape_change.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/remesh/split_edges.h"
#include "palmar/report/picture/display_mesh.h"
#include "palmar/server/live_frame.h"

namespace palmar {

std::vector<double> change_of(const Product& original, const TriangleMesh& changed) {
  // Beyond it, it counts as this far: no redesign moves a surface by as much.
  constexpr double kFarthest = 60.0;  // mm
  std::vector<DistanceSample> samples(changed.vertices.size());
  original.distance->sample(changed.vertices, kFarthest, samples);
  std::vector<double> change;
  change.reserve(samples.size());
  for (const DistanceSample& one : samples) change.push_back(one.distance);
  return change;
}

namespace {

/// CAD meshes have corners only where surfaces bend: so fine that every place can have its colour.
TriangleMesh divided(const TriangleMesh& mesh) {
  constexpr double kFinest = 1.0;  // mm
  // Triangles from halving edges have some 0.25 e^2; not more of them than are shown.
  const double edge = std::sqrt(surface_area(mesh) / (0.25 * kMostShownTriangles));
  return split_long_edges(mesh, std::clamp(edge, kFinest, 1000.0));
}

}  // namespace

std::string shape_frame(const ShelvedProduct& original, const std::filesystem::path& changed) {
  const std::shared_ptr<const Product> product = read_product(original);
  if (changed.empty()) {
    const std::vector<double> none(product->mesh.vertices.size(), 0.0);
    return product_frame(display_mesh(product->mesh, none, kMostShownTriangles).mesh, 0);
  }
  const TriangleMesh mesh = divided(read_mesh(changed).mesh);
  std::vector<double> moved = change_of(*product, mesh);
  for (double& one : moved) one = std::abs(one);
  DisplayMesh shown = display_mesh(mesh, moved, kMostShownTriangles);
  ProductFootprint footprint;
  footprint.surface = std::move(shown.mesh);
  footprint.pressure = std::move(shown.value);
  return footprint_frame(footprint, 0);
}

}  // namespace palmar
