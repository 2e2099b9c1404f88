// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/resolution.h"

#include <cmath>

namespace palmar {
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
    const DistanceSample& other = on_product.sample[w];
    if (other.distance < kNearRange && own.dot(other.normal) < kLeastCosine) return true;
  }
  return false;
}

std::string unresolved_words(const ContactResult& contact) {
  std::string where;
  for (const RegionContact& region : contact.regions) {
    if (!is_told(region)) continue;
    where += (where.empty() ? "" : ", ") + std::string(name_of(region.region)) + " " +
             percent_of(region);
  }
  if (where.empty()) return "";
  return percent_of(contact.total) +
         " of the force is on edges of the product that are sharper than the skin's mesh (" + where +
         "); force and area hold, pressures there don't";
}

}  // namespace palmar
