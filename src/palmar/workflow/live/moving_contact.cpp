// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/live/moving_contact.h"

#include <algorithm>
#include <array>

#include "palmar/contact/prepared/contact_solver.h"
#include "palmar/contact/prepared/contact_totals.h"
#include "palmar/contact/prepared/pressed_skin.h"
#include "palmar/core/enum_index.h"
#include "palmar/geometry/distance/grid_distance.h"
#include "palmar/geometry/mesh/mesh_measures.h"

namespace palmar::workflow {
namespace {

constexpr double kMovingAccuracy = 0.01;  // of the moduli, and with them of forces
// mm; between touching skin and skin that is farther out, the edge of a contact is looked for.
constexpr double kEdgeRange = 1.5;

constexpr double kFinestSpacing = 1.5, kCoarsestSpacing = 2.5;  // mm, of a distance grid
constexpr double kGridBand = 9.0;       // mm; farther skin isn't asked about
constexpr double kMostNodes = 300'000;  // 0.3 s
// Neighbouring nodes of the finest grid look so far apart on a radius of 5 mm.
constexpr double kLeastGradient = 0.985;

}  // namespace

std::shared_ptr<const geometry::DistanceField> distance_for_moving(
    const geometry::TriangleMesh& mesh,
    const std::shared_ptr<const geometry::DistanceField>& distance) {
  const double area = geometry::surface_area(mesh);
  for (double spacing = kFinestSpacing; spacing <= kCoarsestSpacing; spacing += 0.25) {
    const double nodes = area * 2.0 * (kGridBand + 2.0 * spacing) / (spacing * spacing * spacing);
    if (nodes > kMostNodes) continue;
    return std::make_shared<geometry::GridDistance>(
        distance, geometry::GridDistanceOptions{
                      .spacing = spacing, .band = kGridBand, .least_gradient = kLeastGradient});
  }
  return distance;
}

struct MovingContact::Impl {
  explicit Impl(const contact::PreparedHand& prepared)
      : solver(prepared, contact::ContactOptions{}) {}
  contact::ContactSolver::Impl solver;
};

MovingContact::MovingContact(const contact::PreparedHand& prepared)
    : impl_(std::make_unique<Impl>(prepared)) {}
MovingContact::~MovingContact() = default;
MovingContact::MovingContact(MovingContact&&) noexcept = default;
MovingContact& MovingContact::operator=(MovingContact&&) noexcept = default;

void MovingContact::solve(const std::vector<Vec3>& posed_skin,
                          const geometry::Rigid3& product_from_hand,
                          const geometry::DistanceField& product, contact::ContactResult& result) {
  contact::ContactSolver::Impl& solver = impl_->solver;
  if (!solver.prepared->is_on_bone()) {
    solver.solve(posed_skin, product_from_hand, product, std::nullopt, result);
    return;
  }
  solver.solve_forces(posed_skin, product_from_hand, product, kMovingAccuracy, result);
  const contact::SkinOnProduct& skin = solver.skin();
  const std::size_t n = posed_skin.size();
  std::array<double, hand::kRegionCount> depth{}, modulus_of{};
  for (const contact::RegionContact& region : result.regions) {
    depth[index_of(region.region)] = region.max_penetration;
    modulus_of[index_of(region.region)] = region.shear_modulus;
  }
  // Beside what is loaded the skin gives way, too: how far it is from the product tells where
  // between two vertices the contact ends.
  std::vector<int> beside;
  result.distance.resize(n);
  std::vector<double> gap(n), modulus(n);
  for (std::size_t v = 0; v < n; ++v) {
    gap[v] = result.distance[v] = skin.sample[v].distance;
    modulus[v] = modulus_of[index_of(solver.prepared->hand->region[v])];
    if (result.force[v] > 0.0) {
      gap[v] = 0.0;
    } else if (gap[v] < kEdgeRange && result.total.force > 0.0) {
      beside.push_back(static_cast<int>(v));
    }
  }
  if (!beside.empty()) {
    const std::vector<Vec3> motion = solver.motion_on_bone(result, beside);
    for (std::size_t k = 0; k < beside.size(); ++k) {
      const auto v = static_cast<std::size_t>(beside[k]);
      gap[v] = std::max(0.0, gap[v] + motion[k].dot(skin.sample[v].normal));
    }
  }
  result.displacement.resize(n);
  for (std::size_t v = 0; v < n; ++v) result.displacement[v] = gap[v] - result.distance[v];
  const double deepest = result.total.max_penetration;
  result.regions.clear();
  result.total = {};
  result.total.max_penetration = deepest;
  const contact::SkinGeometry pressed =
      contact::pressed_skin(*solver.prepared, skin, result.undeformed);
  contact::add_totals(*solver.prepared, skin, pressed, gap, modulus, depth, modulus_of,
                      solver.options.cell_area, result);
}

}  // namespace palmar::workflow
