// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/hand/hand_contact.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "palmar/contact/contact_test_hand.h"
#include "palmar/contact/footprint/footprint.h"
#include "palmar/contact/footprint/moving_footprint.h"
#include "palmar/contact/prepared/prepared_hand.h"
#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/geometry/distance/analytic_distance.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/remesh/split_edges.h"

namespace palmar::contact {
namespace {

using contact_test::Ball;
using contact_test::ball_hand;
using contact_test::HalfSpace;
using contact_test::Sheet;

constexpr double kRadius = 10.0;  // mm, of the ball of skin

/// A ball of skin with 1 300 vertices (edges of 1.4 mm), prepared once.
const PreparedHand& prepared_ball() {
  static const PreparedHand hand(ball_hand(kRadius, 3));
  return hand;
}

ContactResult press_on_plane(double depth, const ContactOptions& options = {}) {
  const PreparedHand& hand = prepared_ball();
  return solve_hand_contact(hand, hand.hand().skin.vertices, {}, HalfSpace(depth - kRadius),
                            options);
}

TEST(HandContact, BallOnPlaneMeetsHertz) {
  ContactOptions options;
  options.shear_modulus = 0.05;
  for (const double depth : {1.0, 2.0}) {
    const ContactResult contact = press_on_plane(depth, options);
    ASSERT_EQ(contact.status, ContactStatus::kSolved);
    const double force = 16.0 / 3.0 * 0.05 * std::sqrt(kRadius) * std::pow(depth, 1.5);
    EXPECT_NEAR(contact.total.force, force, 0.03 * force);
    const double area = std::numbers::pi * kRadius * depth;
    EXPECT_NEAR(contact.total.area, area, 0.10 * area);
    // The skin pushes the product down, against its outward normal.
    EXPECT_NEAR(contact.total.force_vector.z(), -contact.total.force, 1e-12);
    EXPECT_LT(contact.complementarity_error, 1e-12);
    ASSERT_EQ(contact.regions.size(), 1U);
    EXPECT_EQ(contact.regions[0].region, hand::Region::kMiddleDistal);
  }
}

TEST(HandContact, NothingPenetratesAfterwards) {
  for (const double depth : {0.5, 2.0, 4.0}) {
    const ContactResult contact = press_on_plane(depth);
    EXPECT_LT(contact.residual_penetration_contact, 1e-6);  // mm
    EXPECT_LT(contact.residual_penetration_other, 0.05);    // mm
    for (std::size_t v = 0; v < contact.deformed.size(); ++v) {
      const double gap = contact.deformed[v].z() - (depth - kRadius);
      EXPECT_GT(gap, contact.force[v] > 0.0 ? -1e-6 : -0.05);
      if (contact.force[v] > 0.0) {
        EXPECT_LT(gap, 1e-6);
      }
    }
  }
}

TEST(HandContact, SkinBulgesAroundTheContact) {
  ContactOptions options;
  const ContactResult with = press_on_plane(1.5, options);
  options.swelling = false;
  const ContactResult without = press_on_plane(1.5, options);
  EXPECT_LT(*std::min_element(with.displacement.begin(), with.displacement.end()), -0.3);  // mm
  EXPECT_GE(*std::min_element(without.displacement.begin(), without.displacement.end()), 0.0);
  // The bulge is for the shape only: under the contact it is flattened without force.
  EXPECT_EQ(with.force, without.force);
}

TEST(HandContact, DeformedSkinHasNoStepAroundTheContact) {
  // Neighbours' motions differ at most by the slope of the deformed ball times the edge (1.5 mm).
  // The steepest slopes are those under the contact's edge, where the ball itself rises by
  // tan(acos(8 / 10)) = 0.75, and at the bulge's flank, 2 mm over about b / 2 = 4 mm: less than 1.
  const ContactResult contact = press_on_plane(2.0);
  const SkinGeometry& skin = prepared_ball().impl().skin;
  for (int v = 0; v < skin.vertex_count(); ++v) {
    for (const int w : skin.neighbours(v)) {
      const Vec3 motion_v = contact.deformed[v] - contact.undeformed[v];
      const Vec3 motion_w = contact.deformed[w] - contact.undeformed[w];
      const double edge = (contact.undeformed[v] - contact.undeformed[w]).norm();
      EXPECT_LT((motion_v - motion_w).norm(), 1.0 * edge) << "vertices " << v << ", " << w;
    }
  }
}

TEST(HandContact, ForceGrowsWithDepthAndStiffens) {
  double before = 0.0;
  for (const double depth : {0.5, 1.0, 2.0, 3.0, 4.0}) {
    const ContactResult contact = press_on_plane(depth);
    EXPECT_GT(contact.total.force, before);
    before = contact.total.force;
    EXPECT_NEAR(contact.regions[0].max_penetration, depth, 0.02);
    const hand::StiffeningLaw& law = prepared_ball()
                                         .hand()
                                         .tissue.region[index_of(hand::Region::kMiddleDistal)]
                                         .half_space.nominal;
    EXPECT_NEAR(contact.regions[0].shear_modulus, law.g0 + (law.g_limit - law.g0) * depth / 4.0,
                1e-3);
  }
}

TEST(HandContact, RigidMotionOfHandAndProductChangesNothing) {
  const PreparedHand& hand = prepared_ball();
  const geometry::Rigid3 motion =
      geometry::Rigid3::about_axis(Vec3(1.0, 2.0, -0.5).normalized(), Vec3(3, -4, 9), 1.1);
  std::vector<Vec3> moved;
  for (const Vec3& v : hand.hand().skin.vertices) moved.push_back(motion * v);
  const HalfSpace plane(2.0 - kRadius);
  const ContactResult here = press_on_plane(2.0);
  const ContactResult there = solve_hand_contact(hand, moved, motion.inverse(), plane);
  EXPECT_NEAR(there.total.force, here.total.force, 1e-9);
  EXPECT_NEAR(there.total.peak_pressure, here.total.peak_pressure, 1e-9);
  EXPECT_LT((there.total.centre - here.total.centre).norm(), 1e-6);
}

TEST(HandContact, TheDorsumTouchesToo) {
  // From above, where the skin is dorsum; its distances are not prepared.
  const PreparedHand& hand = prepared_ball();
  const geometry::Rigid3 upside_down =
      geometry::Rigid3::about_axis(Vec3::UnitX(), Vec3::Zero(), std::numbers::pi);
  ContactOptions options;
  options.shear_modulus = 0.05;
  const ContactResult contact = solve_hand_contact(hand, hand.hand().skin.vertices, upside_down,
                                                   HalfSpace(1.0 - kRadius), options);
  ASSERT_EQ(contact.regions.size(), 1U);
  EXPECT_EQ(contact.regions[0].region, hand::Region::kDorsum);
  const double force = 16.0 / 3.0 * 0.05 * std::sqrt(kRadius);
  EXPECT_NEAR(contact.total.force, force, 0.03 * force);
  EXPECT_LT(contact.residual_penetration_contact, 1e-6);
}

TEST(HandContact, ThinSheetPushesBackFromTheSideTheSkinCameFrom) {
  // Depth 2 mm in a sheet of 2.4 mm: the deepest skin is nearer to the far side. The answer must be
  // that of a thick product.
  const PreparedHand& hand = prepared_ball();
  const double top = 2.0 - kRadius;
  const ContactResult thick = press_on_plane(2.0);
  const ContactResult thin =
      solve_hand_contact(hand, hand.hand().skin.vertices, {}, Sheet(top - 2.4, top));
  EXPECT_NEAR(thin.total.force, thick.total.force, 0.02 * thick.total.force);
  EXPECT_GT(thin.total.force_vector.z(), -1.01 * thick.total.force);
  EXPECT_LT(thin.total.force_vector.z(), 0.0);
  EXPECT_LT(thin.residual_penetration_contact, 1e-6);
}

TEST(HandContact, SkinThatIsThroughAFoilIsPushedBackAllTheSame) {
  // Half a millimetre of sheet in 2 mm of flesh: most of the skin is beyond it.
  const PreparedHand& hand = prepared_ball();
  const double top = 2.0 - kRadius;
  const ContactResult thick = press_on_plane(2.0);
  const ContactResult foil =
      solve_hand_contact(hand, hand.hand().skin.vertices, {}, Sheet(top - 0.5, top));
  EXPECT_NEAR(foil.total.force, thick.total.force, 0.02 * thick.total.force);
  EXPECT_NEAR(foil.total.area, thick.total.area, 0.05 * thick.total.area);
  EXPECT_LT(foil.residual_penetration_contact, 1e-6);
}

TEST(HandContact, SkinFarInsideCarriesNoForceAndIsReported) {
  // A ball of skin in the middle of a ball of 40 mm: every vertex is 30 mm deep.
  const PreparedHand& hand = prepared_ball();
  const ContactResult contact =
      solve_hand_contact(hand, hand.hand().skin.vertices, {}, Ball(Vec3::Zero(), 40.0));
  EXPECT_NE(contact.message, "");
  EXPECT_EQ(contact.total.force, 0.0);
}

TEST(HandContact, ApartIsNoContact) {
  const ContactResult contact = press_on_plane(-1.0);
  EXPECT_EQ(contact.status, ContactStatus::kNoContact);
  EXPECT_EQ(contact.total.force, 0.0);
  EXPECT_EQ(contact.deformed, contact.undeformed);
}

TEST(HandContact, RefusesWrongInput) {
  using testing::HasSubstr;
  using testing::ThrowsMessage;
  EXPECT_THAT([] { solve_hand_contact(prepared_ball(), {}, {}, HalfSpace(0.0)); },
              ThrowsMessage<UsageError>(HasSubstr("posed skin has 0 points")));
  ContactOptions options;
  options.cell_area = -24.0;
  EXPECT_THAT([&] { press_on_plane(1.0, options); },
              ThrowsMessage<UsageError>(HasSubstr("cell_area is -24")));
}

/// Of a pressure that is linear over the triangles, N.
double integral_of(const geometry::TriangleMesh& surface, const std::vector<double>& pressure) {
  double force = 0.0;
  for (const Triangle& t : surface.triangles) {
    const Vec3& a = surface.vertices[t[0]];
    const double area = 0.5 * (surface.vertices[t[1]] - a).cross(surface.vertices[t[2]] - a).norm();
    force += area / 3.0 * (pressure[t[0]] + pressure[t[1]] + pressure[t[2]]);
  }
  return force;
}

TEST(Footprint, CarriesTheForceOfTheSkin) {
  const ContactResult contact = press_on_plane(2.0);
  geometry::TriangleMesh plate = geometry::make_grid_patch(2, 2, 30.0);
  for (Vec3& v : plate.vertices) v += Vec3(-30.0, -30.0, 2.0 - kRadius);
  const ProductFootprint footprint = map_to_product(prepared_ball().hand(), contact, plate, 0.7);
  ASSERT_EQ(footprint.pressure.size(), footprint.surface.vertices.size());
  const double force = integral_of(footprint.surface, footprint.pressure);
  const double area = geometry::surface_area(footprint.surface);
  EXPECT_NEAR(area, 3600.0, 1e-6);  // the shape is unchanged
  // Linear on the plate's triangles instead of the skin's.
  EXPECT_NEAR(force, contact.total.force, 0.01 * contact.total.force);
  // A cap of 2 mm height on a ball of 10 mm loses a tenth of its area when it is flattened, at its
  // rim; in the middle, where the pressure is highest, nothing.
  EXPECT_NEAR(*std::max_element(footprint.pressure.begin(), footprint.pressure.end()),
              contact.total.peak_pressure, 0.03 * contact.total.peak_pressure);
}

TEST(Footprint, GoesRoundASharpEdge) {
  // A ball of skin on the edge between x = 20 and y = 20 mm, which goes 5 mm into it: facets of
  // skin lead from one side to the other, straight through the product.
  const PreparedHand& hand = prepared_ball();
  const double away = (kRadius - 5.0) / std::sqrt(2.0);
  geometry::Rigid3 product_from_hand;
  product_from_hand.translation = Vec3(20.0 + away, 20.0 + away, 0.0);
  const auto edge =
      geometry::make_prism_distance({.width = 40, .depth = 40, .length = 60, .fillet_radius = 0});
  const ContactResult contact =
      solve_hand_contact(hand, hand.hand().skin.vertices, product_from_hand, *edge);
  ASSERT_GT(contact.total.force, 0.0);
  const ProductFootprint footprint =
      map_to_product(hand.hand(), contact, geometry::make_box(Vec3(40, 40, 60), 20), 0.7);
  const double force = integral_of(footprint.surface, footprint.pressure);
  // The way round the edge is longer than that through it, by up to a factor of sqrt 2; the force
  // is the same.
  EXPECT_NEAR(force, contact.total.force, 0.05 * contact.total.force);
}

TEST(MovingFootprint, CarriesTheForceOfTheSkinAndForgetsTheLastOne) {
  geometry::TriangleMesh plate = geometry::make_grid_patch(2, 2, 30.0);
  for (Vec3& v : plate.vertices) v += Vec3(-30.0, -30.0, 2.0 - kRadius);
  MovingFootprint moving(geometry::split_long_edges(plate, 0.7));
  const ContactResult contact = press_on_plane(2.0);
  const MovingFootprint::Loaded& loaded = moving.under(prepared_ball().hand(), contact);
  std::vector<double> pressure(moving.surface().vertices.size(), 0.0);
  for (std::size_t k = 0; k < loaded.vertex.size(); ++k) {
    pressure[loaded.vertex[k]] = loaded.pressure[k];
  }
  EXPECT_NEAR(integral_of(moving.surface(), pressure), contact.total.force,
              0.02 * contact.total.force);
  EXPECT_NEAR(*std::max_element(pressure.begin(), pressure.end()), contact.total.peak_pressure,
              0.03 * contact.total.peak_pressure);
  EXPECT_TRUE(std::is_sorted(loaded.vertex.begin(), loaded.vertex.end()));
  // Half as deep a smaller part is pressed on, and nothing is left of what was.
  const std::size_t before = loaded.vertex.size();
  const ContactResult less = press_on_plane(1.0);
  const double force = less.total.force;
  moving.under(prepared_ball().hand(), less);
  EXPECT_LT(loaded.vertex.size(), 0.7 * static_cast<double>(before));
  EXPECT_LT(force, contact.total.force);
  EXPECT_TRUE(moving.under(prepared_ball().hand(), press_on_plane(-1.0)).vertex.empty());
}

TEST(MovingFootprint, SkinPressesOnlyTheSideThatItFaces) {
  // A plate of 0.5 mm: its other side lies within reach of the skin.
  geometry::TriangleMesh plate = geometry::make_box(Vec3(60.0, 60.0, 0.5), 1);
  for (Vec3& v : plate.vertices) v.z() += 2.0 - kRadius - 0.25;
  MovingFootprint moving(geometry::split_long_edges(plate, 1.5));
  const MovingFootprint::Loaded& loaded = moving.under(prepared_ball().hand(), press_on_plane(2.0));
  ASSERT_FALSE(loaded.vertex.empty());
  for (const int v : loaded.vertex) {
    EXPECT_NEAR(moving.surface().vertices[v].z(), 2.0 - kRadius, 1e-9) << "vertex " << v;
  }
}

TEST(MovingFootprint, SurfaceIsAsFineAsItsTrianglesAllow) {
  const geometry::TriangleMesh box = geometry::make_box(Vec3(40.0, 30.0, 130.0), 1);
  const geometry::TriangleMesh fine = surface_for_moving(box, 120000);
  EXPECT_GT(fine.triangle_count(), 5000);
  EXPECT_NEAR(geometry::surface_area(fine), geometry::surface_area(box),
              1e-6 * geometry::surface_area(box));
  const geometry::TriangleMesh coarse = surface_for_moving(box, 1000);
  EXPECT_LE(coarse.triangle_count(), 1000);
  EXPECT_GT(coarse.triangle_count(), 200);
}

}  // namespace
}  // namespace palmar::contact
