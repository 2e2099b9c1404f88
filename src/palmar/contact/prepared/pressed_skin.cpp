// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/prepared/pressed_skin.h"
#include "palmar/geometry/mesh/mesh_measures.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palmar::contact {
namespace {

/// Of the area at rest; a force needs some area to be spread over. Ten times less changes no
/// pressure, which is never told for less than the area at rest. Our choice.
constexpr double kSmallestShare = 1e-3;

}  // namespace

SkinGeometry pressed_skin(const PreparedHand::Impl& prepared, const SkinOnProduct& skin,
                          const std::vector<Vec3>& undeformed) {
  if (prepared.model == xie2014_model()) return prepared.skin;
  SkinGeometry result;
  result.ring_begin = prepared.skin.ring_begin;
  result.ring = prepared.skin.ring;
  result.normal = skin.normal;
  geometry::TriangleMesh on_product{undeformed, prepared.hand->skin.triangles};
  for (const int v : skin.near) {
    const geometry::DistanceSample& sample = skin.sample[v];
    if (sample.distance >= kNearRange) continue;
    on_product.vertices[v] = sample.closest;
    // Skin faces the product.
    result.normal[v] = -sample.normal;
  }
  result.area = geometry::vertex_areas(on_product);
  result.position = std::move(on_product.vertices);
  result.radius.reserve(result.area.size());
  for (std::size_t v = 0; v < result.area.size(); ++v) {
    result.area[v] = std::max(result.area[v], kSmallestShare * prepared.skin.area[v]);
    result.radius.push_back(std::sqrt(result.area[v] / std::numbers::pi));
  }
  return result;
}

std::vector<double> pressure_on_skin(const SkinGeometry& pressed,
                                     const std::vector<double>& at_rest,
                                     const std::vector<double>& force) {
  std::vector<double> pressure(force.size(), 0.0);
  std::vector<int> crowded;
  std::vector<double> cell_area;
  for (std::size_t v = 0; v < force.size(); ++v) {
    if (!(force[v] > 0.0)) continue;
    if (pressed.area[v] >= at_rest[v]) {
      pressure[v] = force[v] / pressed.area[v];
      continue;
    }
    crowded.push_back(static_cast<int>(v));
    cell_area.push_back(at_rest[v]);
  }
  const SensorCells cells = sensor_cells(pressed, crowded, cell_area);
  for (std::size_t c = 0; c < crowded.size(); ++c) {
    double sum = 0.0;
    double area = 0.0;
    for (int k = cells.begin[c]; k < cells.begin[c + 1]; ++k) {
      const int w = cells.vertex[k];
      sum += force[w] * cells.shared[k] / pressed.area[w];
      area += cells.shared[k];
    }
    pressure[crowded[c]] = sum / area;
  }
  return pressure;
}

}  // namespace palmar::contact
