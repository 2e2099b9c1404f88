// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/holds/fit_holds.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "palmar/core/error.h"

namespace palmar::grasp {
namespace {

constexpr double kApart = 1000.0;  // mm between holds: none is mistaken for another

OpposedHold hold_at(double place, ShapeFeatures features) {
  OpposedHold hold;
  for (Vec3& point : hold.points.point) point = Vec3(place, 0.0, 0.0);
  hold.features = features;
  return hold;
}

/// Far above the table, which then says nothing but which way is up.
ObservedHold seen(const HandPoints& points, const Vec3& up = Vec3::UnitZ()) {
  return {points, {.up = up, .table = -1e9}};
}

ObservedHold seen_at(double place) { return seen(hold_at(place, ShapeFeatures::Zero()).points); }

/// A palm that faces x, its thumb's side to z, before it is turned.
PalmPlace turned_palm(const Quat& turn) {
  return {.faces = turn * Vec3::UnitX(), .thumb_side = turn * Vec3::UnitZ()};
}

/// Two kinds of holds that one feature tells apart, `first` of people's at the one and the others
/// at the other.
ObservedObject two_kinds(int first, int others) {
  ObservedObject object;
  object.name = "bar";
  ShapeFeatures features = ShapeFeatures::Zero();
  object.candidates.push_back(hold_at(0.0, features));
  features[0] = 1.0;
  object.candidates.push_back(hold_at(kApart, features));
  object.candidates.push_back(hold_at(2.0 * kApart, features));
  for (int i = 0; i < first; ++i) object.seen.push_back(seen_at(0.0));
  for (int i = 0; i < others; ++i) object.seen.push_back(seen_at(kApart));
  return object;
}

// The likelihood of a logit with one feature of two values is largest at the logarithm of the odds
// (McFadden 1974): here, of two holds of the second kind one of which alone is seen,
// p_2 / p_1 = (others / 2) / first if each is as likely.
TEST(FitHolds, OneFeatureOfTwoValuesGetsTheLogarithmOfTheOdds) {
  ObservedObject object = two_kinds(1000, 3000);
  for (int i = 0; i < 3000; ++i) object.seen.push_back(seen_at(2.0 * kApart));
  const HoldFit fit = fit_holds({object, object});
  const double slope = fit.weights.weight[0] / fit.weights.spread[0];
  EXPECT_NEAR(slope, std::log(3.0), 0.01);  // the ridge pulls it down a little
  for (int k = 1; k < kHoldFeatureCount; ++k) EXPECT_NEAR(fit.weights.weight[k], 0.0, 1e-9);
  // These say nothing of how it lay: not to know it changes nothing.
  EXPECT_NEAR(fit.weights.unseen[0], fit.weights.weight[0], 1e-6);
  // -sum p ln p with p = 1/7, 3/7, 3/7.
  EXPECT_NEAR(fit.likelihood, std::log(1.0 / 7.0) / 7.0 + 6.0 / 7.0 * std::log(3.0 / 7.0), 1e-4);
}

TEST(FitHolds, FindsWeightsThatHoldsWereDrawnWith) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  ShapeFeatures truth;
  truth << 1.0, -0.5, 0.0, 0.3, -1.2, 0.0, 0.8, 0.0, -0.2;
  constexpr double kThumbUp = 1.5, kPalmDown = 0.7;
  std::vector<ObservedObject> objects(8);
  for (ObservedObject& object : objects) {
    object.name = "thing";
    for (int c = 0; c < 200; ++c) {
      ShapeFeatures features;
      for (double& x : features) x = normal(random);
      const Quat turn =
          Quat(normal(random), normal(random), normal(random), normal(random)).normalized();
      object.candidates.push_back(hold_at(c * kApart, features));
      object.candidates.back().palm = turned_palm(turn);
    }
    for (int i = 0; i < 400; ++i) {
      const Vec3 up = Vec3(normal(random), normal(random), normal(random)).normalized();
      std::vector<double> chance;
      for (const OpposedHold& hold : object.candidates) {
        chance.push_back(std::exp(truth.dot(hold.features) +
                                  kThumbUp * up.dot(hold.palm.thumb_side) -
                                  kPalmDown * up.dot(hold.palm.faces)));
      }
      std::discrete_distribution<int> draw(chance.begin(), chance.end());
      object.seen.push_back(
          seen(object.candidates[static_cast<std::size_t>(draw(random))].points, up));
    }
  }
  const HoldFit fit = fit_holds(objects);
  const ShapeFeatures found = fit.weights.shape_slope(true);
  for (int k = 0; k < kShapeFeatureCount; ++k) EXPECT_NEAR(found[k], truth[k], 0.1) << k;
  EXPECT_NEAR(fit.weights.table_slope()[0], kThumbUp, 0.1);
  EXPECT_NEAR(fit.weights.table_slope()[1], kPalmDown, 0.1);
  EXPECT_NEAR(fit.weights.table_slope()[2], 0.0, 1e-9);  // nothing is lower than the table
  // What is left out is told nearly as well as what is fitted, and better than by even chances; to
  // know how it had lain tells more.
  for (const LeftOut& one : fit.left_out) {
    EXPECT_GT(one.likelihood, one.even + 0.5);
    EXPECT_GT(one.likelihood, one.unseen + 0.2);
    EXPECT_NEAR(one.likelihood, fit.likelihood, 0.5);
    EXPECT_NEAR(one.even, -std::log(200.0), 1e-6);
    EXPECT_EQ(one.seen, 400);
  }
}

TEST(FitHolds, HowItLiesCountsWhereThatIsKnown) {
  const Quat over(Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitX()));  // thumb's side down
  std::vector<OpposedHold> holds(2);
  holds[0].palm = turned_palm(Quat::Identity());
  holds[1].palm = turned_palm(over);
  for (OpposedHold& hold : holds) hold.features.setZero();
  HoldWeights weights;
  weights.weight[kShapeFeatureCount] = 0.5 * std::log(3.0);  // thumb's side up: three to one
  EXPECT_NEAR(chances(weights, holds)[0], 0.5, 1e-12);
  EXPECT_NEAR(chances(weights, holds, Standing{.table = -1e9})[0], 0.75, 1e-12);
  // Shape counts by weights of its own where that isn't known.
  holds[1].features[0] = 1.0;
  weights.unseen[0] = std::log(4.0);
  EXPECT_NEAR(chances(weights, holds)[0], 0.2, 1e-12);
  EXPECT_NEAR(chances(weights, holds, Standing{.table = -1e9})[0], 0.75, 1e-12);
}

TEST(FitHolds, TheFirstModeIsWherePeoplesHoldsAreDensestAndTheNextElsewhere) {
  // Three alike holds of 0.2 each beside one of 0.4: together they are denser.
  std::vector<OpposedHold> holds;
  for (const double place : {0.0, 3.0, 6.0, kApart}) {
    holds.push_back(hold_at(place, ShapeFeatures::Zero()));
  }
  Eigen::VectorXd chance(4);
  chance << 0.2, 0.2, 0.2, 0.4;
  const std::vector<HoldMode> modes = modes_of(holds, chance, 8);
  ASSERT_EQ(modes.size(), 2U);  // the two beside the first are the same hold
  EXPECT_EQ(modes[0].hold, 1U);
  EXPECT_EQ(modes[0].score, 0.0);
  EXPECT_EQ(modes[1].hold, 3U);
  const double near = std::exp(-0.5 * 9.0 / 400.0);  // 3 mm at a density of 20 mm
  EXPECT_NEAR(modes[1].score, std::log(0.4 / (0.2 + 0.4 * near)), 1e-12);
}

TEST(FitHolds, RefusesWhatCantBeFitted) {
  const auto message = [](const std::vector<ObservedObject>& objects) -> std::string {
    try {
      fit_holds(objects);
    } catch (const UsageError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message({two_kinds(1, 1)}), "fitting holds: at least two objects are required");
  ObservedObject unseen = two_kinds(0, 0);
  EXPECT_EQ(message({unseen, unseen}), "fitting holds: bar has no holds of people");
  ObservedObject sheet = two_kinds(1, 1);
  sheet.candidates.clear();
  EXPECT_EQ(message({sheet, sheet}),
            "fitting holds: bar has no two opposite places that a hand spans");
}

}  // namespace
}  // namespace palmar::grasp
