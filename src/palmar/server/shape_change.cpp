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

namespace palmar::server {

std::vector<double> change_of(const product::Product& original,
                              const geometry::TriangleMesh& changed) {
  // Beyond it, it counts as this far: no redesign moves a surface by as much.
  constexpr double kFarthest = 60.0;  // mm
  std::vector<geometry::DistanceSample> samples(changed.vertices.size());
  original.distance->sample(changed.vertices, kFarthest, samples);
  std::vector<double> change;
  change.reserve(samples.size());
  for (const geometry::DistanceSample& one : samples) change.push_back(one.distance);
  return change;
}

namespace {

/// CAD meshes have corners only where surfaces bend: so fine that every place can have its colour.
geometry::TriangleMesh divided(const geometry::TriangleMesh& mesh) {
  constexpr double kFinest = 1.0;  // mm
  // Triangles from halving edges have some 0.25 e^2; not more of them than are shown.
  const double edge = std::sqrt(geometry::surface_area(mesh) / (0.25 * kMostShownTriangles));
  return geometry::split_long_edges(mesh, std::clamp(edge, kFinest, 1000.0));
}

}  // namespace

std::string shape_frame(const ShelvedProduct& original, const std::filesystem::path& changed) {
  const std::shared_ptr<const product::Product> product = read_product(original);
  if (changed.empty()) {
    const std::vector<double> none(product->mesh.vertices.size(), 0.0);
    return product_frame(report::display_mesh(product->mesh, none, kMostShownTriangles).mesh, 0);
  }
  const geometry::TriangleMesh mesh = divided(formats::read_mesh(changed).mesh);
  std::vector<double> moved = change_of(*product, mesh);
  for (double& one : moved) one = std::abs(one);
  report::DisplayMesh shown = report::display_mesh(mesh, moved, kMostShownTriangles);
  contact::ProductFootprint footprint;
  footprint.surface = std::move(shown.mesh);
  footprint.pressure = std::move(shown.value);
  return footprint_frame(footprint, 0);
}

}  // namespace palmar::server
