// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/prepared/pressed_skin.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "palmar/contact/contact_test_hand.h"
#include "palmar/geometry/distance/analytic_distance.h"

namespace palmar::contact {
namespace {

using contact_test::ball_hand;
using contact_test::HalfSpace;

constexpr double kAtRest = 10.0;  // mm, radius of the ball of skin

const PreparedHand& fine_ball() {
  static const PreparedHand hand(ball_hand(kAtRest, 4));
  return hand;
}

/// The ball with its skin stretched `stretch` times in every direction, on a plate.
ContactResult press_stretched(const PreparedHand& hand, double stretch, double depth) {
  std::vector<Vec3> posed;
  for (const Vec3& v : hand.hand().skin.vertices) posed.push_back(stretch * v);
  ContactOptions options;
  options.shear_modulus = 0.05;
  return solve_hand_contact(hand, posed, {}, HalfSpace(depth - stretch * kAtRest), options);
}

TEST(PressedSkin, AreaOfAStretchedBallIsThatOfTheBallItIs) {
  // Tissue is at rest in the ball of 10 mm, so the solver sees the profile r^2 / 2 R in lengths at
  // rest; Hertz' radius, stretched, is that of the ball of the radius that it has now: pi R depth.
  for (const double stretch : {0.8, 1.0, 1.3}) {
    const ContactResult contact = press_stretched(fine_ball(), stretch, 1.0);
    ASSERT_EQ(contact.status, ContactStatus::kSolved);
    const double area = std::numbers::pi * stretch * kAtRest * 1.0;
    EXPECT_NEAR(contact.total.area, area, 0.05 * area) << stretch;
    // Hertz: the highest pressure is 1.5 times the mean, wherever the area counts.
    EXPECT_NEAR(contact.total.mean_pressure, contact.total.force / area,
                0.05 * contact.total.force / area);
    EXPECT_NEAR(contact.total.peak_pressure, 1.5 * contact.total.force / area,
                0.08 * contact.total.force / area)
        << stretch;
  }
}

TEST(PressedSkin, TheThesisCountsAtRest) {
  const PreparedHand thesis(ball_hand(kAtRest, 3), xie2014_model());
  const PreparedHand ours(ball_hand(kAtRest, 3));
  std::vector<Vec3> posed;
  for (const Vec3& v : ours.hand().skin.vertices) posed.push_back(2.0 * v);
  const SkinOnProduct skin =
      find_skin_on_product(ours.hand(), posed, HalfSpace(1.0 - 2.0 * kAtRest), {});
  EXPECT_EQ(pressed_skin(thesis.impl(), skin, posed).area, thesis.impl().skin.area);
  // Stretched twice, skin has four times the area where it lies flat.
  const auto lowest = std::min_element(posed.begin(), posed.end(),
                                       [](const Vec3& a, const Vec3& b) { return a.z() < b.z(); });
  const auto v = static_cast<std::size_t>(lowest - posed.begin());
  const SkinGeometry pressed = pressed_skin(ours.impl(), skin, posed);
  EXPECT_NEAR(pressed.area[v], 4.0 * ours.impl().skin.area[v], 0.04 * pressed.area[v]);
  EXPECT_NEAR(pressed.position[v].z(), 1.0 - 2.0 * kAtRest, 1e-12);
}

TEST(PressedSkin, PressureTimesAreaIsTheForceAndNothingIsFinerThanTheMesh) {
  // Skin at rest on a plane lattice; then everything left of x = 0 is drawn together to a fifth.
  const geometry::TriangleMesh mesh = geometry::make_lattice_patch(12.0, 1.5);
  const SkinGeometry at_rest = skin_geometry(mesh);
  geometry::TriangleMesh drawn = mesh;
  for (Vec3& v : drawn.vertices) v.x() *= v.x() < 0.0 ? 0.2 : 1.0;
  const SkinGeometry pressed = skin_geometry(drawn);
  std::vector<double> force(mesh.vertices.size(), 0.0);
  double all = 0.0;
  for (std::size_t v = 0; v < force.size(); ++v) {
    if (drawn.vertices[v].norm() > 6.0) continue;
    force[v] = 0.01 * pressed.area[v];
    all += force[v];
  }
  const std::vector<double> pressure = pressure_on_skin(pressed, at_rest.area, force);
  double sum = 0.0;
  for (std::size_t v = 0; v < force.size(); ++v) {
    sum += pressure[v] * pressed.area[v];
    EXPECT_LT(pressure[v], 0.0115);
  }
  EXPECT_NEAR(sum, all, 0.06 * all);
  // One loaded vertex in the crowd: its force counts over its area at rest, not over a fifth of it.
  int one = 0;
  for (int v = 0; v < pressed.vertex_count(); ++v) {
    if ((pressed.position[v] - Vec3(-1, 0, 0)).norm() <
        (pressed.position[one] - Vec3(-1, 0, 0)).norm()) {
      one = v;
    }
  }
  std::fill(force.begin(), force.end(), 0.0);
  force[one] = 1.0;
  const std::vector<double> alone = pressure_on_skin(pressed, at_rest.area, force);
  EXPECT_NEAR(alone[one], 1.0 / at_rest.area[one], 0.15 / at_rest.area[one]);
  EXPECT_LT(pressed.area[one], 0.3 * at_rest.area[one]);
}

}  // namespace
}  // namespace palmar::contact
