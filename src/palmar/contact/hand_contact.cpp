// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/hand_contact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "palmar/contact/contact_totals.h"
#include "palmar/contact/deformed_skin.h"
#include "palmar/contact/lcp.h"
#include "palmar/contact/lemke.h"
#include "palmar/contact/prepared_hand.h"
#include "palmar/contact/response.h"
#include "palmar/contact/skin_product.h"
#include "palmar/contact/sub_active_region.h"
#include "palmar/core/error.h"

namespace palmar {
namespace {

/// Splits the collision region by the 19 regions, and the dorsum by connected patches.
std::vector<SubActiveRegion> split_by_region(const PreparedHand::Impl& prepared,
                                             const SkinOnProduct& skin) {
  std::array<std::vector<int>, kRegionCount> collision;
  for (const int v : skin.collision) {
    collision[static_cast<std::size_t>(prepared.hand->region[v])].push_back(v);
  }
  std::vector<SubActiveRegion> parts;
  for (int r = 0; r < kRegionCount; ++r) {
    if (collision[r].empty()) continue;
    const Region region = static_cast<Region>(r);
    if (region != Region::kDorsum) {
      SubActiveRegion& part = parts.emplace_back();
      part.region = region;
      part.collision = std::move(collision[r]);
      continue;
    }
    for (std::vector<int>& patch : connected_parts(prepared.skin, collision[r])) {
      SubActiveRegion& part = parts.emplace_back();
      part.region = region;
      part.collision = std::move(patch);
    }
  }
  return parts;
}

/// Rows and columns of the responses that a part needs.
void attach_response(const PreparedHand::Impl& prepared, SubActiveRegion& part) {
  if (part.region != Region::kDorsum) {
    part.response = &prepared.region[static_cast<std::size_t>(part.region)];
    for (const int v : part.collision) part.columns.push_back(prepared.row[v]);
    return;
  }
  const RegionTissue& tissue = prepared.tissue(part.region);
  std::vector<int> around;
  for (const GrownVertex& g : grow(prepared.skin, part.collision, tissue.neighbourhood)) {
    if (g.distance > 0.0) around.push_back(g.vertex);
  }
  part.own_response = response_between(prepared, tissue, part.collision, around);
  part.response = &part.own_response;
  for (int k = 0; k < part.own_response.columns; ++k) part.columns.push_back(k);
}

/// Solves the LCP of one part on its penetrating vertices. Returns false if no solver found an
/// answer.
bool solve_part(const PreparedHand::Impl& prepared, const SkinOnProduct& skin,
                const ContactOptions& options, SubActiveRegion& part, ContactResult& result) {
  attach_response(prepared, part);
  ContactProblem problem;
  const auto m = static_cast<Eigen::Index>(part.collision.size());
  problem.distance.resize(m);
  for (Eigen::Index k = 0; k < m; ++k)
    problem.distance[k] = skin.sample[part.collision[k]].distance;
  part.d_max = -problem.distance.minCoeff();
  part.shear_modulus = options.shear_modulus.value_or(
      shear_modulus_at(prepared.tissue(part.region).half_space.nominal, part.d_max));
  problem.response =
      part.response->bou(part.columns, part.columns).cast<double>() / part.shear_modulus;
  ContactSolution solution = solve_contact(problem);
  if (solution.status != LcpStatus::kSolved) solution = solve_contact_lemke(problem);
  part.force = solution.force;
  part.gap = solution.gap;
  result.iterations += solution.pivots;
  result.complementarity_error =
      std::max(result.complementarity_error, solution.complementarity_error);
  return solution.status == LcpStatus::kSolved;
}

}  // namespace

void ContactOptions::check() const {
  if (!(cell_area > 0.0 && cell_area <= 1000.0)) {
    throw UsageError("cell_area is " + std::to_string(cell_area) +
                     " mm^2; more than 0 and at most 1000 mm^2 is required");
  }
  if (shear_modulus && !(*shear_modulus > 0.0 && std::isfinite(*shear_modulus))) {
    throw UsageError("shear_modulus is " + std::to_string(*shear_modulus) +
                     " MPa; a finite value above 0 is required");
  }
}

ContactResult solve_region_contact(const PreparedHand& hand, const std::vector<Vec3>& posed_skin,
                                   const Rigid3& product_from_hand, const DistanceField& product,
                                   const ContactOptions& options, std::optional<Region> only) {
  options.check();
  const PreparedHand::Impl& prepared = hand.impl();
  const std::size_t n = prepared.hand->skin.vertices.size();
  if (posed_skin.size() != n) {
    throw UsageError("contact: posed skin has " + std::to_string(posed_skin.size()) +
                     " points; the hand's skin has " + std::to_string(n) + " vertices");
  }
  ContactResult result;
  result.model = prepared.model;
  result.undeformed.reserve(n);
  for (const Vec3& v : posed_skin) result.undeformed.push_back(product_from_hand * v);
  SkinOnProduct skin = find_skin_on_product(*prepared.hand, result.undeformed, product, only);
  result.message = skin.message;
  result.force.assign(n, 0.0);
  result.pressure.assign(n, 0.0);

  std::vector<SubActiveRegion> parts = split_by_region(prepared, skin);
  result.status = parts.empty() ? ContactStatus::kNoContact : ContactStatus::kSolved;
  if (skin.is_too_deep) result.status = ContactStatus::kTooDeep;
  for (SubActiveRegion& part : parts) {
    if (!solve_part(prepared, skin, options, part, result)) {
      result.status = ContactStatus::kNotConverged;
      result.message += (result.message.empty() ? "" : "; ");
      result.message += "contact of region " + std::string(name_of(part.region)) + " (" +
                        std::to_string(part.collision.size()) +
                        " penetrating vertices) has no solution; it carries no force";
    }
    for (std::size_t k = 0; k < part.collision.size(); ++k) {
      const int v = part.collision[k];
      const double p = part.force[static_cast<Eigen::Index>(k)];
      result.force[v] = p;
      result.pressure[v] = p / prepared.skin.area[v];
    }
  }
  const SkinDisplacement u = skin_displacement(prepared, skin, parts, options.swelling);
  result.displacement = u.with_bulge;
  deform_skin(prepared.skin, skin, product, u.is_active, result);

  result.distance.reserve(n);
  for (const DistanceSample& sample : skin.sample) result.distance.push_back(sample.distance);
  std::vector<double> shear_modulus(n, 0.0);
  std::vector<double> gap(n);
  for (std::size_t v = 0; v < n; ++v) gap[v] = result.distance[v] + u.elastic[v];
  std::array<double, kRegionCount> d_max{};
  std::array<double, kRegionCount> modulus{};
  for (const SubActiveRegion& part : parts) {
    for (const int v : part.collision) shear_modulus[v] = part.shear_modulus;
    const auto r = static_cast<std::size_t>(part.region);
    if (part.d_max >= d_max[r]) {
      d_max[r] = part.d_max;
      modulus[r] = part.shear_modulus;
    }
  }
  add_totals(prepared, skin, gap, shear_modulus, d_max, modulus, options.cell_area, result);
  return result;
}

ContactResult solve_hand_contact(const PreparedHand& prepared, const std::vector<Vec3>& posed_skin,
                                 const Rigid3& product_from_hand, const DistanceField& product,
                                 const ContactOptions& options) {
  return solve_region_contact(prepared, posed_skin, product_from_hand, product, options,
                              std::nullopt);
}

struct ContactSolver::Impl {
  const PreparedHand* prepared = nullptr;
  ContactOptions options;
};

ContactSolver::ContactSolver(const PreparedHand& prepared, const ContactOptions& options)
    : impl_(std::make_unique<Impl>(Impl{&prepared, options})) {
  options.check();
}
ContactSolver::~ContactSolver() = default;
ContactSolver::ContactSolver(ContactSolver&&) noexcept = default;
ContactSolver& ContactSolver::operator=(ContactSolver&&) noexcept = default;

void ContactSolver::solve(const std::vector<Vec3>& posed_skin, const Rigid3& product_from_hand,
                          const DistanceField& product, ContactResult& result) {
  result =
      solve_hand_contact(*impl_->prepared, posed_skin, product_from_hand, product, impl_->options);
}

}  // namespace palmar
