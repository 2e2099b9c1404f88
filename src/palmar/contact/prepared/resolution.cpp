// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/prepared/resolution.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace palmar::contact {
namespace {

std::string percent_of(const RegionContact& contact) {
  return std::to_string(std::lround(100.0 * contact.unresolved_force / contact.force)) + " %";
}

bool is_told(const RegionContact& contact) {
  return contact.unresolved_force > kToldShare * contact.force;
}

}  // namespace

bool is_unresolved(const SkinGeometry& skin, const SkinOnProduct& on_product, int vertex) {
  static const double kLeastCosine = std::cos(kResolvedTurn);
  const Vec3& own = on_product.sample[vertex].normal;
  for (const int w : skin.neighbours(vertex)) {
    const geometry::DistanceSample& other = on_product.sample[w];
    if (other.distance < kNearRange && own.dot(other.normal) < kLeastCosine) return true;
  }
  return false;
}

bool is_resolved(const ContactResult& contact) {
  if (contact.refinement) return contact.refinement->is_resolved;
  return std::none_of(contact.regions.begin(), contact.regions.end(), is_told);
}

std::string refinement_words(const ContactResult& contact) {
  if (!contact.refinement || contact.refinement->levels == 0) return "";
  const ContactRefinement& refinement = *contact.refinement;
  const long tenths = std::max(1L, std::lround(10.0 * refinement.finest_edge));
  return std::to_string(refinement.vertices) +
         " vertices were added to the skin on edges of the product, down to edges of " +
         std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) +
         " mm; the last halving moved the highest pressures on cells by " +
         std::to_string(std::lround(100.0 * refinement.peak_change)) + " %";
}

std::string unresolved_words(const ContactResult& contact) {
  if (is_resolved(contact)) return "";
  if (contact.refinement && contact.refinement->levels > 0) return refinement_words(contact);
  constexpr std::size_t kMostNamed = 3;
  std::vector<RegionContact> told;
  for (const RegionContact& region : contact.regions) {
    if (is_told(region)) told.push_back(region);
  }
  std::stable_sort(told.begin(), told.end(), [](const RegionContact& a, const RegionContact& b) {
    return a.peak_pressure_cells > b.peak_pressure_cells;
  });
  std::string where;
  for (std::size_t i = 0; i < std::min(told.size(), kMostNamed); ++i) {
    where += (where.empty() ? "" : ", ") + std::string(name_of(told[i].region)) + " " +
             percent_of(told[i]);
  }
  if (told.size() > kMostNamed) {
    const std::size_t more = told.size() - kMostNamed;
    where += " and " + std::to_string(more) + (more == 1 ? " other region" : " other regions");
  }
  return percent_of(contact.total) +
         " of the force is on edges of the product that are sharper than the skin's mesh (" +
         where +
         "); the highest pressures there may be off by 40 %, the hand's force and area hold";
}

}  // namespace palmar::contact
