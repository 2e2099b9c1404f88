// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/prepared/coarse_hand.h"

#include <gtest/gtest.h>

#include <cmath>

#include "palmar/contact/bone/contact_test_skin.h"
#include "palmar/contact/prepared/contact_solver.h"
#include "palmar/contact/prepared/prepared_hand.h"

namespace palmar::contact {
namespace {

const PreparedHand& flat() {
  static const PreparedHand hand = contact_test::flat_skin_on_half_space(18.0, 1.0);
  return hand;
}

/// How far even pressure moves the skin it lies on in the mean, by the forces' work: a_i z . C_ij z
/// a_j, with the vertices' areas.
double work_of_even_pressure(const SkinCompliance& compliance, const std::vector<double>& area) {
  double sum = 0.0;
  for (std::size_t i = 0; i < compliance.vertex.size(); ++i) {
    for (std::size_t k = compliance.begin[i]; k < compliance.begin[i + 1]; ++k) {
      const auto j = static_cast<std::size_t>(compliance.other[k]);
      sum += (i == j ? 1.0 : 2.0) * area[compliance.vertex[i]] * area[compliance.vertex[j]] *
             static_cast<double>(compliance.tensor[k](2, 2));
    }
  }
  return sum;
}

TEST(CoarseHand, GivesWayToEvenPressureAsTheWholeSkin) {
  const CoarseHand& coarse = flat().coarse();
  EXPECT_LT(coarse.sample.vertex.size(), flat().hand().skin.vertices.size() / 4);
  std::vector<double> area(coarse.sample.vertex.size(), 0.0);
  const SkinGeometry& skin = flat().impl().skin;
  for (std::size_t v = 0; v < skin.area.size(); ++v) area[coarse.sample.entry[v]] += skin.area[v];
  const double fine = work_of_even_pressure(*flat().impl().compliance, skin.area);
  EXPECT_NEAR(work_of_even_pressure(*coarse.prepared.impl().compliance, area), fine, 1e-4 * fine);
}

/// Force of a ball pressed into the skin, by forces alone, N.
double pressed_by_ball(const PreparedHand& hand, double radius, double depth) {
  ContactOptions options;
  options.shear_modulus = 0.02;
  ContactSolver::Impl solver(hand, options);
  const auto ball = geometry::make_sphere_distance(radius);
  geometry::Rigid3 place;
  place.translation = Vec3(0.0, 0.0, depth - radius);
  place.rotation = Quat::Identity();
  ContactResult result;
  solver.solve_forces(hand.hand().skin.vertices, place, *ball, 1e-6, result);
  return result.total.force;
}

// Hertz 1882, nu = 1/2: F = 16/3 G sqrt(R) d^1.5.
TEST(CoarseHand, MeetsHertzWithinAFewPerCent) {
  for (const double depth : {1.0, 1.2, 1.4}) {
    constexpr double kRadius = 60.0;
    const double exact = 16.0 / 3.0 * 0.02 * std::sqrt(kRadius) * std::pow(depth, 1.5);
    EXPECT_NEAR(pressed_by_ball(flat(), kRadius, depth), exact, 0.03 * exact);
    EXPECT_NEAR(pressed_by_ball(flat().coarse().prepared, kRadius, depth), exact, 0.08 * exact);
  }
}

TEST(CoarseHand, KeepsRegionsAndHangsTogether) {
  const CoarseHand& coarse = flat().coarse();
  const SkinGeometry& skin = coarse.prepared.impl().skin;
  for (int v = 0; v < skin.vertex_count(); ++v) {
    EXPECT_FALSE(skin.neighbours(v).empty());
    EXPECT_EQ(coarse.prepared.hand().region[v], flat().hand().region[coarse.sample.vertex[v]]);
    EXPECT_GT(skin.normal[v].z(), 0.99);
  }
}

}  // namespace
}  // namespace palmar::contact
