// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/indices/fitness.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/geometry/distance/analytic_distance.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::grasp {
namespace {

/// A ball of palmar skin about the origin; its half z > 0 is the dorsum, the half x < 0 of the rest
/// thenar, the other hypothenar.
hand::Hand ball_hand(double radius) {
  hand::Hand hand;
  hand.skin = geometry::make_icosphere(radius, 5);
  for (const Vec3& v : hand.skin.vertices) {
    hand.region.push_back(v.z() > 0.0   ? hand::Region::kDorsum
                          : v.x() < 0.0 ? hand::Region::kThenar
                                        : hand::Region::kHypothenar);
  }
  return hand;
}

/// Solid outside of a ball: a bowl that the hand lies in.
class Bowl : public geometry::DistanceField {
 public:
  explicit Bowl(double radius) : radius_(radius) {}
  void sample(std::span<const Vec3> points, double /*range*/,
              std::span<geometry::DistanceSample> samples) const override {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3 u = points[i].normalized();
      samples[i] = {radius_ - points[i].norm(), radius_ * u, -u, -1};
    }
  }
  Box3 bounding_box() const override { return {Vec3::Constant(-100), Vec3::Constant(100)}; }

 private:
  double radius_;
};

/// Solid below z = height.
class Floor : public geometry::DistanceField {
 public:
  explicit Floor(double height) : height_(height) {}
  void sample(std::span<const Vec3> points, double /*range*/,
              std::span<geometry::DistanceSample> samples) const override {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double d = points[i].z() - height_;
      samples[i] = {d, points[i] - d * Vec3::UnitZ(), Vec3::UnitZ(), -1};
    }
  }
  Box3 bounding_box() const override { return {Vec3::Constant(-100), Vec3::Constant(100)}; }

 private:
  double height_;
};

TEST(Fitness, BowlOfTheSameShapeFitsPerfectly) {
  const hand::Hand hand = ball_hand(20.0);
  for (const double gap : {1.5, 0.0, -2.0}) {
    const FitnessResult found =
        assess_fitness(hand, hand.skin.vertices, geometry::Rigid3{}, Bowl(20.0 + gap));
    EXPECT_NEAR(found.total.mean, gap, 1e-9);
    EXPECT_NEAR(found.total.median, gap, 1e-9);
    EXPECT_NEAR(found.total.deviation, 0.0, 1e-9);
    EXPECT_NEAR(found.total.within_1_mm, 1.0, 1e-12);
    EXPECT_NEAR(found.contact_share, 1.0, 1e-12);
    EXPECT_LT(found.total.normal_angle, 0.02);  // normals of the mesh
    EXPECT_EQ(found.regions.size(), 2u);        // no dorsum
    // Half of the ball; vertices on the rim count as palmar.
    EXPECT_NEAR(found.total.skin_area, 2.0 * std::numbers::pi * 400.0, 80.0);
  }
}

TEST(Fitness, BallOnAFloorHasTheGapsOfACap) {
  // Gap of a ball of radius R that touches a plane: even between 0 and the reach by area
  // (Archimedes), so mean reach / 2 and deviation reach / sqrt(12).
  const hand::Hand hand = ball_hand(20.0);
  FitnessOptions options;
  options.reach = 6.0;
  const FitnessResult found =
      assess_fitness(hand, hand.skin.vertices, geometry::Rigid3{}, Floor(-20.0), options);
  EXPECT_NEAR(found.total.mean, 3.0, 0.05);
  EXPECT_NEAR(found.total.median, 3.0, 0.1);
  EXPECT_NEAR(found.total.deviation, 6.0 / std::sqrt(12.0), 0.03);
  EXPECT_NEAR(found.total.rms, 6.0 / std::sqrt(3.0), 0.05);
  EXPECT_NEAR(found.total.area, 2.0 * std::numbers::pi * 20.0 * 6.0, 20.0);
  EXPECT_NEAR(found.total.within_1_mm, 2.0 / 6.0, 0.03);
  EXPECT_NEAR(found.total.within_2_mm, 4.0 / 6.0, 0.03);
  // Mean angle over a cap: integral of acos(1 - h / R) dh / reach.
  const double c = 1.0 - 6.0 / 20.0;
  EXPECT_NEAR(found.total.normal_angle, 20.0 / 6.0 * (std::sqrt(1.0 - c * c) - c * std::acos(c)),
              0.01);
}

TEST(Fitness, PlacementMovesTheHand) {
  const hand::Hand hand = ball_hand(20.0);
  const geometry::Rigid3 lifted{Quat::Identity(), Vec3(5, -3, 2.0)};
  const FitnessResult a = assess_fitness(hand, hand.skin.vertices, lifted, Floor(-18.0));
  const FitnessResult b =
      assess_fitness(hand, hand.skin.vertices, geometry::Rigid3{}, Floor(-20.0));
  EXPECT_NEAR(a.total.mean, b.total.mean, 1e-9);
  EXPECT_NEAR(a.total.deviation, b.total.deviation, 1e-9);
}

TEST(Fitness, NothingNearIsNamed) {
  const hand::Hand hand = ball_hand(20.0);
  const FitnessResult found =
      assess_fitness(hand, hand.skin.vertices, geometry::Rigid3{}, Floor(-60.0));
  EXPECT_EQ(found.total.area, 0.0);
  for (const GraspIndex& row : to_indices(found)) {
    if (row.key == "skin_near_product_percent") {
      EXPECT_EQ(row.value, 0.0);
    } else {
      EXPECT_FALSE(row.value.has_value()) << row.key;
    }
    EXPECT_THAT(row.remark, testing::HasSubstr("no palmar skin within 8 mm"));
  }
}

TEST(Fitness, RowsStayWithinTheirRange) {
  const hand::Hand hand = ball_hand(20.0);
  for (const GraspIndex& row :
       to_indices(assess_fitness(hand, hand.skin.vertices, geometry::Rigid3{}, Floor(-18.5)))) {
    EXPECT_EQ(row.group, "fitness");
    ASSERT_TRUE(row.value.has_value()) << row.key;
    EXPECT_GE(*row.value, *row.lowest) << row.key;
    EXPECT_LE(*row.value, *row.highest) << row.key;
    EXPECT_FALSE(row.definition.empty()) << row.key;
  }
}

TEST(Fitness, BadInputIsNamed) {
  const hand::Hand hand = ball_hand(20.0);
  FitnessOptions options;
  options.reach = 0.0;
  EXPECT_THROW(assess_fitness(hand, hand.skin.vertices, geometry::Rigid3{}, Floor(0.0), options),
               UsageError);
  EXPECT_THROW(assess_fitness(hand, {}, geometry::Rigid3{}, Floor(0.0)), UsageError);
}

}  // namespace
}  // namespace palmar::grasp
