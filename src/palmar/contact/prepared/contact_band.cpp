// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "palmar/contact/prepared/contact_solver.h"
#include "palmar/contact/prepared/contact_totals.h"
#include "palmar/core/enum_index.h"

namespace palmar::contact {
namespace {

void set_low(const RegionContact& from, ContactBandRow& row) {
  row.force_low = from.force;
  row.area_low = from.area;
  row.peak_pressure_low = from.peak_pressure;
  row.peak_pressure_cells_low = from.peak_pressure_cells;
}

void set_high(const RegionContact& from, ContactBandRow& row) {
  row.force_high = from.force;
  row.area_high = from.area;
  row.peak_pressure_high = from.peak_pressure;
  row.peak_pressure_cells_high = from.peak_pressure_cells;
}

}  // namespace

std::optional<std::array<double, hand::kRegionCount>> ContactSolver::Impl::force_per_modulus(
    const SkinOnProduct& skin, const SkinLoad& load) {
  // With the contact set F held, A_FF p = -b, b_i = G_i d_i, and F = sum of p. With y of
  // A_FF y = 1:  dF = y . (-db - dA p). b is proportional to G, A (but for the coating) without it.
  if (prepared->is_on_bone()) return force_per_modulus_on_bone(skin, load);
  const auto y = system.solve_on(load.in_contact, std::vector<double>(load.vertex.size(), 1.0));
  if (!y) return std::nullopt;
  std::array<double, hand::kRegionCount> result{};
  const auto region_of = [&](std::size_t k) {
    return static_cast<std::size_t>(prepared->hand->region[load.vertex[k]]);
  };
  for (std::size_t k = 0; k < load.vertex.size(); ++k) {
    const double d = skin.sample[load.vertex[k]].distance;
    result[region_of(k)] -= (*y)[k] * load.shear_modulus[k] * d;
    if (!coating_.diagonal.empty()) {
      result[region_of(k)] -= (*y)[k] * coating_.diagonal[k] * load.force[k];
    }
  }
  for (const ContactSystem::Entry& entry : coating_.entries) {
    const int i = entry.row;
    const auto j = static_cast<std::size_t>(entry.column);
    const double both = 0.5 * entry.value * ((*y)[i] * load.force[j] + (*y)[j] * load.force[i]);
    result[region_of(i)] -= both;
    result[region_of(j)] -= both;
  }
  return result;
}

void set_band_level(const ContactResult& at_level, hand::TissueLevel level, ContactBand& band) {
  const auto set = level == hand::TissueLevel::kLow ? set_low : set_high;
  set(at_level.total, band.total);
  for (ContactBandRow& row : band.regions) {
    for (const RegionContact& region : at_level.regions) {
      if (region.region == row.region) set(region, row);
    }
  }
}

ContactBand ContactSolver::Impl::band(const SkinOnProduct& skin, const SkinLoad& load,
                                      const std::vector<double>& gap, const SkinGeometry& pressed,
                                      ContactResult& nominal) {
  ContactBand result;
  for (const RegionContact& region : nominal.regions) {
    result.regions.push_back({.region = region.region});
  }
  const auto known_slope = force_per_modulus(skin, load);
  if (!known_slope) ++nominal.fallbacks.band_levels;
  const std::array<double, hand::kRegionCount> slope =
      known_slope.value_or(std::array<double, hand::kRegionCount>{});
  for (ContactBandRow& row : result.regions) {
    row.force_per_modulus = slope[index_of(row.region)];
    result.total.force_per_modulus += row.force_per_modulus;
  }
  for (const hand::TissueLevel level : {hand::TissueLevel::kLow, hand::TissueLevel::kHigh}) {
    SkinLoad other = load;
    other.level = level;
    other.shear_modulus = moduli(load, level);
    ContactResult at_level;
    const bool is_solved = solve_system(skin, other, at_level);
    nominal.fallbacks += at_level.fallbacks;
    if (!is_solved) {
      ++nominal.fallbacks.band_levels;
      continue;
    }
    const std::size_t n = nominal.force.size();
    at_level.force.assign(n, 0.0);
    at_level.deformed = nominal.deformed;
    std::vector<double> modulus(n, 0.0);
    std::vector<double> gap_at_level = gap;
    for (std::size_t k = 0; k < load.vertex.size(); ++k) {
      const int v = load.vertex[k];
      at_level.force[v] = other.force[k];
      modulus[v] = other.shear_modulus[k];
      gap_at_level[v] = other.gap[k];
    }
    const std::array<double, hand::kRegionCount> none{};
    add_totals(*prepared, skin, pressed, gap_at_level, modulus, none, none, options.cell_area,
               at_level);
    set_band_level(at_level, level, result);
  }
  return result;
}

}  // namespace palmar::contact
