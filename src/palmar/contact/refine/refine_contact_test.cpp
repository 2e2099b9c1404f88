// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/refine/refine_contact.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palmar/contact/bone/contact_test_skin.h"
#include "palmar/contact/contact_test_hand.h"
#include "palmar/contact/prepared/resolution.h"
#include "palmar/contact/refine/refined_contact.h"

namespace palmar::contact {
namespace {

using contact_test::press_on_edge;
using contact_test::press_on_plate;
using contact_test::tip_on_bone;

ContactOptions refined() {
  ContactOptions options;
  options.refine = true;
  return options;
}

const PreparedHand& coarse_tip() {
  static const PreparedHand tip = tip_on_bone(3);  // edges of 1.4 mm
  return tip;
}

/// The tip on an edge with the force of a light grip.
ContactResult press_with_force(double fillet, double force, const ContactOptions& options) {
  double low = 1.4, high = 2.6;
  ContactResult contact;
  for (int i = 0; i < 9; ++i) {
    const double depth = 0.5 * (low + high);
    contact = press_on_edge(coarse_tip(), fillet, depth, options);
    (contact.total.force < force ? low : high) = depth;
  }
  return contact;
}

/// A round bar along y that presses skin in the plane z = 0.
class Bar : public geometry::DistanceField {
 public:
  Bar(double radius, double depth) : radius_(radius), height_(radius - depth) {}
  void sample(std::span<const Vec3> points, double /*range*/,
              std::span<geometry::DistanceSample> samples) const override {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3 axis(0.0, points[i].y(), height_);
      const Vec3 n = (points[i] - axis).normalized();
      samples[i] = {(points[i] - axis).norm() - radius_, axis + radius_ * n, n, -1};
    }
  }
  Box3 bounding_box() const override { return {Vec3::Constant(-1e3), Vec3::Constant(1e3)}; }

 private:
  double radius_, height_;
};

/// Force per length [N/mm] and half the width of the contact [mm] that has the spread of the forces
/// across the bar, twice its standard deviation under a semi-ellipse; from -6 to 6 mm along it.
struct LineLoad {
  double force = 0.0, half_width = 0.0;
};
LineLoad line_load(const ContactResult& contact) {
  constexpr double kHalf = 6.0;
  double sum = 0.0, spread = 0.0;
  for (std::size_t v = 0; v < contact.force.size(); ++v) {
    const Vec3& at = contact.undeformed[v];
    if (std::abs(at.y()) > kHalf) continue;
    sum += contact.force[v];
    spread += contact.force[v] * at.x() * at.x();
  }
  return {sum / (2.0 * kHalf), 2.0 * std::sqrt(spread / sum)};
}

/// Hertz' line contact: a^2 = 4 F' R / (pi E*), E* = 4 G at nu = 1/2 (Johnson 1985, eq. 4.43).
TEST(RefineContact, BarsThinnerThanTheMeshAreHertzLineContacts) {
  const PreparedHand skin = contact_test::flat_skin_on_half_space(16.0, 2.5);
  constexpr double kModulus = 0.05;  // MPa
  for (const double radius : {1.0, 2.0, 4.0}) {
    const Bar bar(radius, 0.2 * radius);
    const auto press = [&](bool refine) {
      ContactOptions options;
      options.refine = refine;
      options.shear_modulus = kModulus;
      return solve_hand_contact(skin, skin.hand().skin.vertices, {}, bar, options);
    };
    const auto error = [&](const LineLoad& line) {
      const double hertz =
          std::sqrt(4.0 * line.force * radius / (std::numbers::pi * 4.0 * kModulus));
      return std::abs(line.half_width / hertz - 1.0);
    };
    const ContactResult contact = press(true);
    ASSERT_EQ(contact.status, ContactStatus::kSolved) << contact.message;
    ASSERT_TRUE(contact.refined) << radius;
    EXPECT_LT(error(line_load(contact.refined->contact)), 0.15) << radius;
    // The mesh has a single row of vertices in the contact of the thin ones.
    if (radius < 3.0) {
      EXPECT_NEAR(error(line_load(press(false))), 1.0, 0.01) << radius;
    }
  }
}

TEST(RefineContact, ThoroughTwoMeshesAgreeOnceTheyAreRefined) {
  const PreparedHand finer = tip_on_bone(4);  // edges of 0.7 mm
  for (const double fillet : {0.0, 2.0}) {
    const ContactResult one = press_on_edge(coarse_tip(), fillet, 2.0, refined());
    const ContactResult other = press_on_edge(finer, fillet, 2.0, refined());
    ASSERT_TRUE(one.refinement && other.refinement);
    EXPECT_TRUE(is_resolved(one)) << fillet;
    EXPECT_NEAR(one.total.force, other.total.force, 0.03 * other.total.force) << fillet;
    // Of the finer mesh less had to be divided, and so is aimed.
    EXPECT_NEAR(one.total.area, other.total.area, 0.15 * other.total.area) << fillet;
    EXPECT_NEAR(one.total.peak_pressure_cells, other.total.peak_pressure_cells,
                0.05 * other.total.peak_pressure_cells)
        << fillet;
    EXPECT_LT(one.complementarity_error, 1e-8 * one.total.force);
  }
}

TEST(RefineContact, ThoroughRounderEdgesPressWiderAndLessWithOneForce) {
  double area = 0.0, peak = 1e3;
  std::vector<double> areas_before;
  for (const double fillet : {0.0, 1.0, 2.0, 3.0}) {
    const ContactResult contact = press_with_force(fillet, 0.5, refined());
    ASSERT_TRUE(contact.refined) << fillet;
    EXPECT_GT(contact.total.area, area) << fillet;
    EXPECT_LT(contact.total.peak_pressure, peak) << fillet;
    area = contact.total.area;
    peak = contact.total.peak_pressure;
    areas_before.push_back(press_with_force(fillet, 0.5, {}).total.area);
  }
  // On its own mesh a sharp edge presses like a fillet of 1 mm.
  EXPECT_NEAR(areas_before[0], areas_before[1], 0.01 * areas_before[1]);
}

TEST(RefineContact, WhatNeedsNoneStaysToTheLastBit) {
  const contact_test::Ball ball(Vec3(0.0, 0.0, -29.0), 21.0);
  const auto press = [&](const ContactOptions& options) {
    return solve_hand_contact(coarse_tip(), coarse_tip().hand().skin.vertices, {}, ball, options);
  };
  const ContactResult with = press(refined());
  const ContactResult without = press({});
  ASSERT_GT(with.total.force, 0.0);
  EXPECT_FALSE(with.refinement);
  EXPECT_EQ(with.refined, nullptr);
  EXPECT_TRUE(is_resolved(with));
  EXPECT_EQ(with.total.force, without.total.force);
  EXPECT_EQ(with.total.peak_pressure_cells, without.total.peak_pressure_cells);
  EXPECT_EQ(with.force, without.force);
  EXPECT_EQ(with.pressure, without.pressure);
}

TEST(RefineContact, TellsOfTheRefinedSkinAndKeepsTheOwnOne) {
  ContactOptions options = refined();
  options.error_band = true;
  const ContactResult with = press_on_edge(coarse_tip(), 1.0, 2.0, options);
  const ContactResult without = press_on_edge(coarse_tip(), 1.0, 2.0, {});
  ASSERT_TRUE(with.refined && with.refinement && with.band);
  EXPECT_EQ(with.force, without.force);
  EXPECT_EQ(with.deformed, without.deformed);
  EXPECT_EQ(with.refinement->peak_before, without.total.peak_pressure_cells);
  EXPECT_GE(with.refinement->levels, 2);
  EXPECT_LT(with.refinement->finest_edge, 0.5);
  const ContactResult& fine = with.refined->contact;
  EXPECT_EQ(fine.force.size(), with.force.size() + with.refinement->vertices);
  EXPECT_EQ(with.refined->hand->region.size(), fine.force.size());
  EXPECT_EQ(with.total.force, fine.total.force);
  double sum = 0.0;
  for (const double force : fine.force) sum += force;
  EXPECT_NEAR(sum, with.total.force, 1e-9);
  EXPECT_LT(with.band->total.force_low, with.total.force);
  EXPECT_GT(with.band->total.force_high, with.total.force);
  EXPECT_THAT(refinement_words(with), testing::HasSubstr("the last halving moved the highest"));
  EXPECT_EQ(unresolved_words(with), "");
  EXPECT_NE(unresolved_words(without), "");
}

TEST(RefineContact, LeavesThePointKernelAlone) {
  ContactModel model;
  model.kernel = Kernel::kPoint;
  const PreparedHand ball(contact_test::ball_hand(contact_test::kTipRadius, 3), model);
  const ContactResult contact = press_on_edge(ball, 0.5, 1.5, refined());
  EXPECT_FALSE(contact.refinement);
  EXPECT_FALSE(is_resolved(contact));
}

/// Skin on the edge of a plate has its sides nearest as soon as it is deeper than half its
/// thickness; it is the edge that presses it. A thicker plate takes more force to the same depth,
/// and one of a millimetre still a good part of it: the force per length of a line grows with the
/// logarithm of its width only (Johnson 1985, section 2.4).
TEST(RefineContact, TheEdgeOfAPlatePressesTheMoreTheThickerItIs) {
  for (const bool is_refined : {false, true}) {
    ContactOptions options;
    options.refine = is_refined;
    for (const double depth : {1.0, 2.0, 3.0}) {
      double thinner = 0.0;
      double widest = press_on_plate(coarse_tip(), 10.0, depth, options).total.force;
      for (const double thickness : {1.0, 2.0, 3.0}) {
        const double force = press_on_plate(coarse_tip(), thickness, depth, options).total.force;
        // Without refinement plates thinner than the skin's triangles meet the same vertices.
        EXPECT_GE(force, thinner * (1.0 - 1e-6))
            << is_refined << " " << depth << " mm, " << thickness;
        if (is_refined) {
          EXPECT_GT(force, thinner) << depth << " mm, " << thickness;
        }
        EXPECT_GT(force, 0.2 * widest);
        thinner = force;
      }
      EXPECT_LT(thinner, widest);
    }
  }
}

}  // namespace
}  // namespace palmar::contact
