// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/prepared/contact_solver.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>

#include "palmar/contact/prepared/contact_totals.h"
#include "palmar/contact/prepared/deformed_skin.h"
#include "palmar/contact/prepared/pressed_skin.h"
#include "palmar/contact/prepared/sub_active_region.h"
#include "palmar/contact/response/layered_response.h"
#include "palmar/contact/response/response.h"
#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_measures.h"

namespace palmar::contact {
namespace {

constexpr int kMostExtensions = 8;     // of the problem by skin that bulges into the product
constexpr double kCoatingReach = 5.0;  // thicknesses; beyond, a layer's response is gone
// mm; skin farther from other skin doesn't come to touch it by bulging: twice what a flank pressed
// at the limit depth bulges. Ours.
constexpr double kNearSkin = 2.0;

}  // namespace

void append_note(std::string& message, const std::string& text) {
  if (!message.empty()) message += "; ";
  message += text;
}

ContactSolver::Impl::Impl(const PreparedHand& prepared_hand, const ContactOptions& contact_options)
    : hand(&prepared_hand),
      prepared(&prepared_hand.impl()),
      options(contact_options),
      system(prepared->blocks) {
  if (options.skin_on_skin && !prepared->is_on_bone()) {
    throw UsageError("contact: skin on skin needs tissue on bone; the tissue model is " +
                     std::string(name_of(prepared->model.tissue)));
  }
  if (prepared->is_on_bone()) {
    loaded_.emplace(prepared->skin, *prepared->compliance, &prepared->response, prepared->scale);
    on_self_.emplace(prepared->skin, *prepared->compliance, prepared->scale);
  }
}

void ContactSolver::Impl::set_depth(const SkinOnProduct& skin, SkinLoad& load) const {
  if (prepared->model.coupling == RegionCoupling::kCoupled) {
    load.depth =
        local_depth(prepared->stiffness, prepared->skin, load.vertex, skin.collision, skin.sample);
    return;
  }
  // d_max of the sub-active region; of the dorsum's connected patch.
  std::array<double, hand::kRegionCount> d_max{};
  std::vector<int> dorsal;
  for (const int v : skin.collision) {
    const hand::Region region = prepared->hand->region[v];
    double& d = d_max[index_of(region)];
    d = std::max(d, -skin.sample[v].distance);
    if (region == hand::Region::kDorsum) dorsal.push_back(v);
  }
  std::vector<double> by_vertex(skin.sample.size(), 0.0);
  for (const std::vector<int>& patch : connected_parts(prepared->skin, dorsal)) {
    double d = 0.0;
    for (const int v : patch) d = std::max(d, -skin.sample[v].distance);
    for (const int v : patch) by_vertex[v] = d;
  }
  load.depth.clear();
  for (const int v : load.vertex) {
    const hand::Region region = prepared->hand->region[v];
    load.depth.push_back(region == hand::Region::kDorsum ? by_vertex[v] : d_max[index_of(region)]);
  }
}

std::vector<double> ContactSolver::Impl::moduli(const SkinLoad& load,
                                                hand::TissueLevel level) const {
  std::vector<double> result;
  result.reserve(load.vertex.size());
  if (prepared->is_on_bone()) {
    const BlockRoots roots(stiffening_);
    for (const int v : load.vertex) {
      const double root = bone_root_modulus(level, roots, v);
      result.push_back(root * root);
    }
    return result;
  }
  const std::vector<hand::StiffeningLaw>& law = prepared->stiffness.law[index_of(level)];
  for (std::size_t k = 0; k < load.vertex.size(); ++k) {
    result.push_back(
        options.shear_modulus.value_or(shear_modulus_at(law[load.vertex[k]], load.depth[k])));
  }
  return result;
}

int ContactSolver::Impl::coating_at(const Vec3& at) const {
  for (std::size_t c = 0; c < options.coatings.size(); ++c) {
    const Box3& box = options.coatings[c].where;
    if (box.isEmpty() || box.contains(at)) return static_cast<int>(c);
  }
  return -1;
}

double ContactSolver::Impl::coating_displacement(const SkinOnProduct& skin, const SkinLoad& load,
                                                 std::size_t v) const {
  const int own = coating_at(skin.sample[v].closest);
  if (own < 0) return 0.0;
  const Coating& coating = options.coatings[own];
  const LayerKernel& kernel = layer_kernel(coating.poisson);
  const double reach = kCoatingReach * coating.thickness;
  double sum = 0.0;
  for (std::size_t k = 0; k < load.vertex.size(); ++k) {
    if (!(load.force[k] > 0.0)) continue;
    const int w = load.vertex[k];
    const double r2 = (skin.sample[v].closest - skin.sample[w].closest).squaredNorm();
    if (r2 >= reach * reach || coating_at(skin.sample[w].closest) != own) continue;
    sum += load.force[k] *
           layered_response(kernel, std::sqrt(r2), prepared->skin.radius[w], coating.thickness);
  }
  return sum / coating.shear_modulus;
}

/// Compliance of the coatings times the mean modulus of the two rows; see ContactSystem.
void ContactSolver::Impl::set_coating(const SkinOnProduct& skin, const SkinLoad& load) {
  coating_ = {};
  if (options.coatings.empty()) return;
  const std::size_t m = load.vertex.size();
  coating_.diagonal.assign(m, 0.0);
  std::vector<int> coat(m, -1);
  for (std::size_t k = 0; k < m; ++k) {
    coat[k] = coating_at(skin.sample[load.vertex[k]].closest);
  }
  for (std::size_t i = 0; i < m; ++i) {
    if (coat[i] < 0) continue;
    const Coating& coating = options.coatings[coat[i]];
    const LayerKernel& kernel = layer_kernel(coating.poisson);
    const int v = load.vertex[i];
    const auto compliance = [&](double r, double a) {
      return layered_response(kernel, r, a, coating.thickness) / coating.shear_modulus;
    };
    coating_.diagonal[i] = load.shear_modulus[i] * compliance(0.0, prepared->skin.radius[v]);
    const double reach = kCoatingReach * coating.thickness;
    for (std::size_t j = 0; j < i; ++j) {
      if (coat[j] != coat[i]) continue;
      const int w = load.vertex[j];
      const double r2 = (skin.sample[v].closest - skin.sample[w].closest).squaredNorm();
      if (r2 >= reach * reach) continue;
      const double r = std::sqrt(r2);
      const double mean =
          0.5 * (compliance(r, prepared->skin.radius[v]) + compliance(r, prepared->skin.radius[w]));
      coating_.entries.push_back({static_cast<int>(i), static_cast<int>(j),
                                  std::sqrt(load.shear_modulus[i] * load.shear_modulus[j]) * mean});
    }
  }
}

void ContactSolver::Impl::assemble(const SkinOnProduct& skin, const SkinLoad& load) {
  const bool is_coupled = prepared->model.coupling == RegionCoupling::kCoupled;
  system.assemble(prepared->response, load.vertex, is_coupled ? nullptr : &prepared->hand->region);
  set_coating(skin, load);
  if (!coating_.diagonal.empty()) system.add(coating_.diagonal, coating_.entries);
}

bool ContactSolver::Impl::solve_system(const SkinOnProduct& skin, SkinLoad& load,
                                       ContactResult& result) {
  if (prepared->is_on_bone()) return solve_on_bone(skin, load, false, result);
  assemble(skin, load);
  std::vector<double> b(load.vertex.size());
  for (std::size_t k = 0; k < b.size(); ++k) {
    b[k] = load.shear_modulus[k] * skin.sample[load.vertex[k]].distance;
  }
  const ContactSystem::Outcome outcome = system.solve(b, load.in_contact, load.force, load.gap);
  result.iterations += outcome.pivots;
  result.fallbacks += outcome.fallbacks;
  double complementarity = 0.0;
  for (std::size_t k = 0; k < b.size(); ++k) {
    load.gap[k] /= load.shear_modulus[k];
    complementarity = std::max(complementarity, std::abs(load.gap[k] * load.force[k]));
  }
  if (outcome.is_solved) {
    result.complementarity_error = std::max(result.complementarity_error, complementarity);
  }
  return outcome.is_solved;
}

/// Skin on skin, which the tissue on bone alone has a law for.
void ContactSolver::Impl::find_meetings(const std::vector<Vec3>& posed,
                                        std::optional<hand::Region> only) {
  if (!on_self_) return;
  if (only || !options.skin_on_skin) return on_self_->clear();
  on_self_->set(prepared->meetings->find(posed, skin_.normal, kNearSkin), posed, skin_.normal);
}

void ContactSolver::Impl::add_touches(ContactResult& result) const {
  result.skin_touch.clear();
  if (on_self_) result.skin_touch = on_self_->touches();
  result.skin_on_skin =
      skin_on_skin(result.skin_touch, prepared->hand->region, prepared->skin.area);
}

/// After the whole problem has failed: each region alone; what has no solution carries no force.
void ContactSolver::Impl::solve_by_region(const SkinOnProduct& skin, SkinLoad& load,
                                          ContactResult& result) {
  result.status = ContactStatus::kNotConverged;
  set_depth(skin, load);
  if (on_self_) on_self_->clear();
  if (prepared->model.coupling == RegionCoupling::kCoupled) {
    ++result.fallbacks.by_region;
    append_note(result.message,
                "the contact of " + std::to_string(load.vertex.size()) +
                    " coupled vertices has no solution; regions were solved one by one");
  }
  for (int r = 0; r < hand::kRegionCount; ++r) {
    std::vector<std::size_t> rows;
    SkinLoad part;
    for (std::size_t k = 0; k < load.vertex.size(); ++k) {
      const int v = load.vertex[k];
      if (static_cast<int>(prepared->hand->region[v]) != r) continue;
      rows.push_back(k);
      part.vertex.push_back(load.vertex[k]);
      part.depth.push_back(load.depth[k]);
      part.shear_modulus.push_back(load.shear_modulus[k]);
      part.in_contact.push_back(skin.sample[v].distance < -0.5 * load.depth[k]);
    }
    if (rows.empty()) continue;
    if (!solve_system(skin, part, result)) {
      ++result.fallbacks.unsolved_regions;
      append_note(result.message, "contact of region " +
                                      std::string(name_of(static_cast<hand::Region>(r))) + " (" +
                                      std::to_string(rows.size()) +
                                      " vertices) has no solution; it carries no force");
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
      load.force[rows[i]] = part.force[i];
      load.gap[rows[i]] = part.gap[i];
      load.in_contact[rows[i]] = part.force[i] > 0.0;
    }
  }
}

std::vector<int> ContactSolver::Impl::pressed_in(const SkinOnProduct& skin,
                                                 const SkinLoad& load) const {
  const std::size_t n = skin.sample.size();
  std::vector<double> sum(n, 0.0);
  const SkinResponse& response = prepared->response;
  const bool is_coupled = prepared->model.coupling == RegionCoupling::kCoupled;
  for (std::size_t k = 0; k < load.vertex.size(); ++k) {
    if (!(load.force[k] > 0.0)) continue;
    const int j = load.vertex[k];
    for (std::size_t e = response.begin[j]; e < response.begin[j + 1]; ++e) {
      const int i = response.vertex[e];
      if (is_coupled || prepared->hand->region[i] == prepared->hand->region[j]) {
        sum[i] += load.force[k] * static_cast<double>(response.response[e]);
      }
    }
  }
  if (response.has_far()) {
    std::vector<double> total(response.cluster_count(), 0.0);
    std::vector<double> moved(total.size(), 0.0);
    for (std::size_t k = 0; k < load.vertex.size(); ++k) {
      response.to_clusters(load.vertex[k], load.force[k], total);
    }
    for (std::size_t c = 0; c < total.size(); ++c) {
      if (total[c] == 0.0) continue;
      for (std::size_t e = response.far.begin[c]; e < response.far.begin[c + 1]; ++e) {
        moved[response.far.vertex[e]] += total[c] * static_cast<double>(response.far.response[e]);
      }
    }
    for (std::size_t i = 0; i < n; ++i) sum[i] += response.from_clusters(i, moved);
  }
  SkinLoad near;
  std::vector<char> is_known(n, 0);
  for (const int v : load.vertex) is_known[v] = 1;
  for (const int v : skin.near) {
    const double d = skin.sample[v].distance;
    const bool may_bulge = sum[v] < 0.0 || !options.coatings.empty();
    if (!is_known[v] && may_bulge && d >= 0.0 && d < kBulgeRange) near.vertex.push_back(v);
  }
  set_depth(skin, near);
  const std::vector<double> modulus = moduli(near, hand::TissueLevel::kNominal);
  std::vector<int> result;
  for (std::size_t k = 0; k < near.vertex.size(); ++k) {
    const auto i = static_cast<std::size_t>(near.vertex[k]);
    double gap = skin.sample[i].distance + sum[i] / modulus[k];
    if (!options.coatings.empty()) gap += coating_displacement(skin, load, i);
    if (gap < 0.0) result.push_back(near.vertex[k]);
  }
  return result;
}

bool ContactSolver::Impl::may_bulge() const {
  return prepared->model.tissue != TissueModel::kHalfSpace || !options.coatings.empty();
}

void ContactSolver::Impl::solve_load(const SkinOnProduct& skin, SkinLoad& load,
                                     ContactResult& result) {
  // A half-space is moved inwards everywhere; a layer bulges beside the contact, and skin that
  // comes to touch that way joins the problem.
  load.vertex = skin.collision;
  if (prepared->is_on_bone() && !was_in_contact.empty()) {
    // What bulged into the product last time is likely to do so again.
    for (const int v : skin.near) {
      const double d = skin.sample[v].distance;
      if (was_in_contact[v] && d >= 0.0 && d < kBulgeRange) load.vertex.push_back(v);
    }
    std::sort(load.vertex.begin(), load.vertex.end());
    load.vertex.erase(std::unique(load.vertex.begin(), load.vertex.end()), load.vertex.end());
  }
  std::vector<char> start(skin.sample.size(), 0);
  const bool is_on_bone = prepared->is_on_bone();
  for (int round = 0;; ++round) {
    const bool is_new = was_in_contact.empty() && round == 0;
    if (!is_on_bone || is_new) set_depth(skin, load);
    if (!is_on_bone) load.shear_modulus = moduli(load, hand::TissueLevel::kNominal);
    load.in_contact.clear();
    load.force.clear();
    for (std::size_t k = 0; k < load.vertex.size(); ++k) {
      const int v = load.vertex[k];
      // Under a smooth product the contact ends where the penetration is half the deepest (Hertz:
      // at r^2 = R depth).
      load.in_contact.push_back(is_new       ? skin.sample[v].distance < -0.5 * load.depth[k]
                                : round == 0 ? was_in_contact[v] != 0
                                             : start[v] != 0);
      load.force.push_back(was_force.empty() ? 0.0 : was_force[v]);
    }
    if (!(is_on_bone ? solve_on_bone(skin, load, true, result)
                     : solve_system(skin, load, result))) {
      solve_by_region(skin, load, result);
      return;
    }
    if (is_on_bone || !may_bulge()) return;
    const std::vector<int> more = pressed_in(skin, load);
    if (more.empty()) return;
    if (round == kMostExtensions) {
      ++result.fallbacks.extension_limits;
      append_note(result.message,
                  std::to_string(more.size()) +
                      " vertices beside the contact still bulge into the product after " +
                      std::to_string(kMostExtensions) + " extensions of the problem");
      return;
    }
    was_force.resize(skin.sample.size(), 0.0);
    for (std::size_t k = 0; k < load.vertex.size(); ++k) {
      const int v = load.vertex[k];
      start[v] = load.in_contact[k];
      was_force[v] = load.force[k];
    }
    for (const int v : more) start[v] = 1;
    load.vertex.insert(load.vertex.end(), more.begin(), more.end());
    std::sort(load.vertex.begin(), load.vertex.end());
  }
}

void ContactSolver::Impl::take_aimed() {
  if (aimed.empty()) return;
  std::vector<int>& collision = skin_.collision;
  for (const auto& [v, sample] : aimed) {
    skin_.sample[v] = sample;
    const auto at = std::lower_bound(collision.begin(), collision.end(), v);
    const bool is_listed = at != collision.end() && *at == v;
    if (is_listed && sample.distance >= 0.0) collision.erase(at);
    if (!is_listed && sample.distance < 0.0) collision.insert(at, v);
  }
}

SkinLoad ContactSolver::Impl::find_forces(const std::vector<Vec3>& posed_skin,
                                          const geometry::Rigid3& product_from_hand,
                                          const geometry::DistanceField& product,
                                          std::optional<hand::Region> only, double wanted,
                                          ContactResult& result) {
  const std::size_t n = prepared->hand->skin.vertices.size();
  if (posed_skin.size() != n) {
    throw UsageError("contact: posed skin has " + std::to_string(posed_skin.size()) +
                     " points; the hand's skin has " + std::to_string(n) + " vertices");
  }
  result.model = prepared->model;
  result.undeformed.resize(n);
  for (std::size_t v = 0; v < n; ++v) result.undeformed[v] = product_from_hand * posed_skin[v];
  undeformed_ = &result.undeformed;
  if (prepared->is_as_printed()) {
    find_skin_as_printed(*prepared->hand, result.undeformed, product, only, skin_);
  } else {
    find_skin_on_product(*prepared->hand, result.undeformed, product, only, &sampler_, skin_,
                         wanted);
    take_aimed();
    skin_.facing.resize(n);
    for (const int v : skin_.near) {
      if (skin_.sample[v].distance < kBulgeRange) {
        skin_.facing[v] = product.smooth_normal(skin_.sample[v]);
      }
    }
  }
  find_meetings(result.undeformed, only);
  const SkinOnProduct& skin = skin_;
  result.message = skin.message;
  result.force.assign(n, 0.0);
  result.pressure.assign(n, 0.0);
  result.regions.clear();
  result.total = {};
  result.band.reset();
  result.iterations = 0;
  result.fallbacks = {};
  result.complementarity_error = 0.0;
  result.residual_penetration_contact = 0.0;
  result.residual_penetration_other = 0.0;
  result.residual_crossing = 0.0;
  result.refinement.reset();
  result.refined.reset();
  result.status = skin.collision.empty() ? ContactStatus::kNoContact : ContactStatus::kSolved;
  if (skin.is_too_deep) result.status = ContactStatus::kTooDeep;

  SkinLoad load;
  if (!skin.collision.empty() && prepared->is_as_printed()) {
    load = solve_as_printed(skin, hand::TissueLevel::kNominal, result);
  } else if (!skin.collision.empty() || (on_self_ && !on_self_->is_empty())) {
    solve_load(skin, load, result);
  }
  add_touches(result);
  const std::vector<double>& covered = coating_.diagonal;
  if (!covered.empty() && *std::max_element(covered.begin(), covered.end()) == 0.0) {
    append_note(result.message, "no skin in contact is on a coated part of the product");
  }
  was_in_contact.assign(n, 0);
  was_force = result.force;
  for (std::size_t k = 0; k < load.vertex.size(); ++k) {
    const int v = load.vertex[k];
    result.force[v] = load.force[k];
    was_in_contact[v] = load.in_contact[k];
    was_force[v] = load.force[k];
  }
  return load;
}

void ContactSolver::Impl::solve_forces(const std::vector<Vec3>& posed_skin,
                                       const geometry::Rigid3& product_from_hand,
                                       const geometry::DistanceField& product, double accuracy,
                                       ContactResult& result) {
  forces_only_ = true;
  forces_accuracy_ = accuracy;
  last_ = find_forces(posed_skin, product_from_hand, product, {}, may_bulge() ? kBulgeRange : 0.0,
                      result);
  const SkinLoad& load = last_;
  const DeepestOfRegion deepest = deepest_of(skin_, load, prepared->hand->region);
  if (prepared->is_as_printed()) {
    deform_as_printed(skin_, load, result);
  } else {
    result.deformed = result.undeformed;
  }
  std::array<double, hand::kRegionCount> force{};
  for (std::size_t v = 0; v < result.force.size(); ++v) {
    if (!(result.force[v] > 0.0)) continue;
    if (!prepared->is_as_printed()) result.deformed[v] = skin_.sample[v].closest;
    force[index_of(prepared->hand->region[v])] += result.force[v];
  }
  for (std::size_t r = 0; r < force.size(); ++r) {
    result.total.max_penetration = std::max(result.total.max_penetration, deepest.depth[r]);
    if (!(force[r] > 0.0)) continue;
    RegionContact& region = result.regions.emplace_back();
    region.region = static_cast<hand::Region>(r);
    region.force = force[r];
    region.max_penetration = deepest.depth[r];
    region.shear_modulus = deepest.shear_modulus[r];
    result.total.force += force[r];
  }
}

void ContactSolver::Impl::solve(const std::vector<Vec3>& posed_skin,
                                const geometry::Rigid3& product_from_hand,
                                const geometry::DistanceField& product,
                                std::optional<hand::Region> only, ContactResult& result) {
  forces_only_ = false;
  const SkinLoad load =
      find_forces(posed_skin, product_from_hand, product, only, kNearRange, result);
  const SkinOnProduct& skin = skin_;
  if (prepared->is_as_printed()) {
    finish_as_printed(skin, product, load, result);
    return;
  }
  const std::size_t n = posed_skin.size();
  std::vector<double> modulus(n, 0.0);
  for (std::size_t k = 0; k < load.vertex.size(); ++k) {
    modulus[load.vertex[k]] = load.shear_modulus[k];
  }
  const std::vector<LoadedPart> parts = loaded_parts(*prepared, load);
  // Tissue on bone bulges by itself.
  SkinDisplacement u =
      skin_displacement(*prepared, skin, load, parts, options.swelling && !prepared->is_on_bone());
  if (prepared->is_on_bone() && !load.vertex.empty()) displace_on_bone(skin, load, u);
  result.displacement = std::move(u.with_bulge);
  std::vector<Vec3> by_skin;
  if (on_self_ && !on_self_->is_empty()) {
    std::vector<int> all(n);
    std::iota(all.begin(), all.end(), 0);
    by_skin = on_self_->displacement(all);
    for (std::size_t v = 0; v < n; ++v) {
      if (!by_skin[v].isZero(0.0)) u.is_active[v] = 1;
    }
  }
  SkinMotion other{by_skin, {}, {}};
  if (!by_skin.empty()) {
    other.vertex = on_self_->corners();
    other.whole =
        on_self_->whole_displacement(other.vertex, load.vertex, load.direction, load.force);
  }
  deform_skin(prepared->skin, skin, product, u.is_active, other, result);

  if (!by_skin.empty()) {
    const std::vector<Vec3> normal =
        geometry::area_weighted_normals(result.deformed, prepared->hand->skin.triangles);
    result.residual_crossing =
        deepest_crossing(prepared->meetings->find(result.deformed, normal, 0.0));
  }

  result.distance.resize(n);
  std::vector<double> gap(n);
  for (std::size_t v = 0; v < n; ++v) {
    result.distance[v] = skin.sample[v].distance;
    gap[v] = result.distance[v] + u.elastic[v];
  }
  const DeepestOfRegion deepest = deepest_of(skin, load, prepared->hand->region);
  const SkinGeometry pressed = pressed_skin(*prepared, skin, result.undeformed);
  add_totals(*prepared, skin, pressed, gap, modulus, deepest.depth, deepest.shear_modulus,
             options.cell_area, result);
  if (options.error_band && !load.vertex.empty()) {
    result.band = band(skin, load, gap, pressed, result);
  }
}

}  // namespace palmar::contact
