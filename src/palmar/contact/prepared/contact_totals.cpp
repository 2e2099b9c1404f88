// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/prepared/contact_totals.h"

#include <algorithm>

#include "palmar/contact/prepared/contact_patch.h"
#include "palmar/contact/prepared/pressed_skin.h"
#include "palmar/contact/prepared/resolution.h"
#include "palmar/contact/prepared/sub_active_region.h"
#include "palmar/core/enum_index.h"

namespace palmar::contact {

DeepestOfRegion deepest_of(const SkinOnProduct& skin, const SkinLoad& load,
                           const std::vector<hand::Region>& region) {
  DeepestOfRegion deepest;
  for (std::size_t k = 0; k < load.vertex.size(); ++k) {
    const int v = load.vertex[k];
    const std::size_t r = index_of(region[v]);
    if (-skin.sample[v].distance < deepest.depth[r]) continue;
    deepest.depth[r] = -skin.sample[v].distance;
    deepest.shear_modulus[r] = load.shear_modulus[k];
  }
  return deepest;
}

void add_totals(const PreparedHand::Impl& prepared, const SkinOnProduct& skin,
                const SkinGeometry& pressed, const std::vector<double>& gap,
                const std::vector<double>& shear_modulus,
                const std::array<double, hand::kRegionCount>& d_max,
                const std::array<double, hand::kRegionCount>& modulus, double cell_area,
                ContactResult& result) {
  const std::size_t n = result.force.size();
  std::array<std::vector<int>, hand::kRegionCount> loaded;
  for (std::size_t v = 0; v < n; ++v) {
    if (result.force[v] <= 0.0) continue;
    loaded[index_of(prepared.hand->region[v])].push_back(static_cast<int>(v));
  }
  const std::vector<Triangle>& triangles = prepared.hand->skin.triangles;
  std::vector<double> area;
  if (prepared.is_as_printed()) {
    area = contact_triangles(result.undeformed, triangles, result.force);
  } else {
    result.pressure = pressure_on_skin(pressed, prepared.skin.area, result.force);
    area = contact_area(pressed.position, triangles, result.pressure, gap, shear_modulus);
  }
  // Peaks are told of the same areas on skin that was divided as on skin that wasn't.
  std::vector<double> told;
  if (!prepared.told_area.empty()) {
    told = pressure_on_skin(pressed, prepared.told_area, result.force);
  }

  RegionContact& total = result.total;
  for (int r = 0; r < hand::kRegionCount; ++r) {
    total.max_penetration = std::max(total.max_penetration, d_max[r]);
    if (loaded[r].empty()) continue;
    RegionContact& part = result.regions.emplace_back();
    part.region = static_cast<hand::Region>(r);
    part.max_penetration = d_max[r];
    part.shear_modulus = modulus[r];
    Vec3 moment = Vec3::Zero();
    double highest = 0.0;
    for (const int v : loaded[r]) {
      highest = std::max(highest, result.pressure[v]);
      if (!told.empty()) part.peak_pressure = std::max(part.peak_pressure, told[v]);
    }
    if (told.empty()) part.peak_pressure = highest;
    for (const int v : loaded[r]) {
      // A patch of few vertices is finer than the mesh: its edge correction would leave an area on
      // which the mean exceeds the peak. No vertex gets less than its force needs at the peak.
      if (!prepared.is_as_printed()) {
        area[v] = std::max(area[v], result.force[v] / highest);
      }
      part.force += result.force[v];
      if (is_unresolved(pressed, skin, v)) part.unresolved_force += result.force[v];
      // The skin pushes the product inwards, against the product's outward normal.
      part.force_vector -= result.force[v] * skin.sample[v].normal;
      part.area += area[v];
      moment += result.force[v] * result.deformed[v];
    }
    // Of a patch smaller than those that peaks are told of, the area is that of the force at the
    // peak.
    if (!told.empty()) part.area = std::max(part.area, part.force / part.peak_pressure);
    part.mean_pressure = part.area > 0.0 ? part.force / part.area : 0.0;
    part.centre = moment / part.force;
    // A region's own cells see its own load; those of the whole hand see all of it.
    const CellPeaks peaks =
        peak_over_cells(pressed, loaded[r], result.force, prepared.hand->region, cell_area);
    part.peak_pressure_cells = peaks.own;
    total.peak_pressure_cells = std::max(total.peak_pressure_cells, peaks.all);
    total.force += part.force;
    total.unresolved_force += part.unresolved_force;
    total.force_vector += part.force_vector;
    total.area += part.area;
    total.peak_pressure = std::max(total.peak_pressure, part.peak_pressure);
    total.centre += moment;
  }
  if (total.force > 0.0) total.centre /= total.force;
  if (total.area > 0.0) total.mean_pressure = total.force / total.area;
}

}  // namespace palmar::contact
