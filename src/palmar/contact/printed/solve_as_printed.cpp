// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The contact of Xie 2014, A7, and what is reported of it; sub_active_region.h has the steps
// before.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "palmar/contact/prepared/contact_solver.h"
#include "palmar/contact/prepared/contact_totals.h"
#include "palmar/contact/prepared/sub_active_region.h"
#include "palmar/contact/solve/lemke.h"

namespace palmar::contact {
namespace {

void add_note(std::string& message, const std::string& text) {
  if (!message.empty()) message += "; ";
  message += text;
}

}  // namespace

SkinLoad ContactSolver::Impl::solve_as_printed(const SkinOnProduct& skin, hand::TissueLevel level,
                                               ContactResult& result) const {
  struct Row {
    int vertex;
    double depth, shear_modulus, force, gap;
  };
  std::vector<Row> rows;
  for (SubActiveRegion& part : sub_active_regions(*prepared, skin, level, options.shear_modulus)) {
    const double swelling = options.swelling ? part.swelling : 0.0;
    part.swelling = swelling;
    ContactSolution solution = solve_contact_lemke(printed_problem(*prepared, part, skin));
    result.iterations += solution.pivots;
    const auto where = [&] {
      return "region " + std::string(name_of(part.region)) + " (" +
             std::to_string(part.vertex.size()) + " vertices)";
    };
    if (solution.status != LcpStatus::kSolved && swelling > 0.0) {
      ++result.fallbacks.without_bulge;
      add_note(result.message, "Lemke's method finds no solution of the printed equations in " +
                                   where() + "; solved with the bulge left out of them");
      part.swelling = 0.0;
      solution = solve_contact_lemke(printed_problem(*prepared, part, skin));
      result.iterations += solution.pivots;
      part.swelling = swelling;
      if (solution.status == LcpStatus::kSolved) {
        // What would stand in the product is flat against it (eq. 3-7).
        const Eigen::VectorXd bulge = printed_bulge(*prepared, part, skin, solution.force);
        solution.gap = (solution.gap - bulge).cwiseMax(solution.gap.cwiseMin(0.0));
      }
    }
    if (solution.status != LcpStatus::kSolved) {
      ++result.fallbacks.unsolved_regions;
      result.status = ContactStatus::kNotConverged;
      add_note(result.message, "contact of " + where() + " has no solution; it carries no force");
      solution.gap.setZero();
      for (std::size_t k = 0; k < part.vertex.size(); ++k) {
        solution.gap[static_cast<Eigen::Index>(k)] = skin.sample[part.vertex[k]].distance;
      }
    }
    result.complementarity_error =
        std::max(result.complementarity_error, solution.complementarity_error);
    for (std::size_t k = 0; k < part.vertex.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      rows.push_back(
          {part.vertex[k], part.d_max, part.shear_modulus, solution.force[i], solution.gap[i]});
    }
  }
  std::sort(rows.begin(), rows.end(),
            [](const Row& a, const Row& b) { return a.vertex < b.vertex; });
  SkinLoad load;
  load.level = level;
  for (const Row& row : rows) {
    load.vertex.push_back(row.vertex);
    load.depth.push_back(row.depth);
    load.shear_modulus.push_back(row.shear_modulus);
    load.force.push_back(row.force);
    load.gap.push_back(row.gap);
    load.in_contact.push_back(row.force > 0.0);
  }
  return load;
}

void ContactSolver::Impl::deform_as_printed(const SkinOnProduct& skin, const SkinLoad& load,
                                            ContactResult& result) {
  const std::size_t n = result.undeformed.size();
  result.deformed = result.undeformed;
  result.displacement.assign(n, 0.0);
  result.force.assign(n, 0.0);
  result.pressure.assign(n, 0.0);
  for (std::size_t k = 0; k < load.vertex.size(); ++k) {
    const int v = load.vertex[k];
    const double u = load.gap[k] - skin.sample[v].distance;  // s = u + d (3-13)
    result.displacement[v] = u;
    result.deformed[v] -= u * skin.normal[v];  // (3-15)
    result.force[v] = load.force[k];
  }
}

void ContactSolver::Impl::finish_as_printed(const SkinOnProduct& skin,
                                            const geometry::DistanceField& product,
                                            const SkinLoad& load, ContactResult& result) const {
  deform_as_printed(skin, load, result);
  const std::size_t n = result.undeformed.size();
  result.distance.resize(n);
  for (std::size_t v = 0; v < n; ++v) {
    result.distance[v] = std::min(skin.sample[v].distance, kNearRange);
    result.pressure[v] = result.force[v] / prepared->skin.area[v];
  }
  std::vector<geometry::DistanceSample> after(n);
  sample_vertices(product, result.deformed, load.vertex, kNearRange, after);
  for (const int v : load.vertex) {
    double& residual = result.force[v] > 0.0 ? result.residual_penetration_contact
                                             : result.residual_penetration_other;
    const double d = after[v].distance;
    residual = std::max(residual, result.force[v] > 0.0 ? std::abs(d) : -d);
  }
  const DeepestOfRegion deepest = deepest_of(skin, load, prepared->hand->region);
  add_totals(*prepared, skin, prepared->skin, {}, {}, deepest.depth, deepest.shear_modulus,
             options.cell_area, result);
  if (options.error_band && !load.vertex.empty()) result.band = band_as_printed(skin, result);
}

ContactBand ContactSolver::Impl::band_as_printed(const SkinOnProduct& skin,
                                                 ContactResult& nominal) const {
  ContactBand result;
  // G0, and with it a G, is the same at all levels: R_act is proportional to 1 / G, the contact set
  // stays, and the force of a region is proportional to its modulus.
  for (const RegionContact& region : nominal.regions) {
    result.regions.push_back({.region = region.region, .force_per_modulus = region.force});
  }
  result.total.force_per_modulus = nominal.total.force;
  for (const hand::TissueLevel level : {hand::TissueLevel::kLow, hand::TissueLevel::kHigh}) {
    ContactResult other;
    other.undeformed = nominal.undeformed;
    const SkinLoad load = solve_as_printed(skin, level, other);
    if (other.fallbacks.unsolved_regions > 0) ++nominal.fallbacks.band_levels;
    nominal.fallbacks += other.fallbacks;
    deform_as_printed(skin, load, other);
    for (std::size_t v = 0; v < other.force.size(); ++v) {
      other.pressure[v] = other.force[v] / prepared->skin.area[v];
    }
    const std::array<double, hand::kRegionCount> none{};
    add_totals(*prepared, skin, prepared->skin, {}, {}, none, none, options.cell_area, other);
    set_band_level(other, level, result);
  }
  return result;
}

}  // namespace palmar::contact
