// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/redesign/hold_offsets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "palmar/product/parts/part_place.h"
#include "palmar/product/primitives.h"
#include "palmar/study/statistics/study_test_results.h"
#include "palmar/workflow/redesign/hold_gains.h"

namespace palmar::workflow {
namespace {

TEST(SpreadOffsets, AreNormallyDistributedAndIndependent) {
  for (const int count : {2, 3, 5, 8, 20}) {
    const auto offsets = spread_offsets(count, 5.0, 0.1);
    ASSERT_EQ(offsets.size(), static_cast<std::size_t>(count));
    std::set<long> turns;
    double along = 0.0, turn = 0.0, squares = 0.0, product = 0.0;
    for (const HoldOffset& one : offsets) {
      turns.insert(std::lround(1e6 * one.turn));
      along += one.along;
      turn += one.turn;
      squares += one.along * one.along;
      product += one.along * one.turn;
    }
    EXPECT_EQ(turns.size(), offsets.size()) << count;  // every turn once
    EXPECT_NEAR(along, 0.0, 1e-9);
    EXPECT_NEAR(turn, 0.0, 1e-9);
    if (count < 5) continue;
    // Middles of equally likely intervals leave the tails out: 0.86 of the deviation with 5.
    EXPECT_GT(std::sqrt(squares / count), 0.8 * 5.0) << count;
    EXPECT_LT(std::sqrt(squares / count), 5.0) << count;
    EXPECT_LT(std::abs(product / count), 0.4 * 5.0 * 0.1) << count;
  }
}

TEST(MovedHold, LiesTowardsTheThumbWhicheverWayThePartRuns) {
  product::CylinderProductOptions options;
  options.diameter = 40.0;
  options.length = 140.0;
  const product::ProductPart part =
      product::find_parts(product::make_cylinder_product(options)).parts.at(0);
  for (const int toward : {1, -1}) {
    grasp::Hold hold;
    hold.along = 0.5;
    hold.toward = toward;
    const grasp::Hold moved = moved_hold(hold, part, {.along = 7.0, .turn = 0.2});
    const geometry::Rigid3 from = product::part_frame(part, hold.along, hold.turn);
    const geometry::Rigid3 to = product::part_frame(part, moved.along, moved.turn);
    const Vec3 thumb = toward * (from.rotation * Vec3::UnitX());
    EXPECT_NEAR((to.translation - from.translation).dot(thumb), 7.0, 0.01);
    EXPECT_NEAR(from.rotation.angularDistance(to.rotation), 0.2, 1e-6);
  }
}

/// Two products in hands whose peaks are 0.2 and 0.2 (1 + change).
study::StudyResults changed_by(double change, int hands) {
  study::StudyResults results = testing::study_of(hands, {"original", "shaped"});
  for (int h = 0; h < hands; ++h) {
    for (int product = 0; product < 2; ++product) {
      study::StudyTask task;
      task.hand = h;
      task.product = product;
      results.records.push_back(testing::held(study::number_of(results.plan, task),
                                              product == 0 ? 0.2 : 0.2 * (1 + change)));
    }
  }
  return results;
}

TEST(HoldGains, AreSharesOfTheOriginalsMeanWithAnInterval) {
  study::StudyResults results = changed_by(-0.1, 2);
  results.records[3].peak_pressure_cells = 0.16;  // -20 % in the second hand
  const HoldGain gain = gain_of(results, "peak_pressure_cells_mpa", {0, 1});
  EXPECT_NEAR(gain.change, -0.15, 1e-12);
  // Differences 0.02 and 0.04: standard error 0.01, Student's t with 1 degree of freedom 12.706.
  EXPECT_NEAR(gain.low, -0.15 - 12.706 * 0.05, 1e-3);
  EXPECT_NEAR(gain.high, -0.15 + 12.706 * 0.05, 1e-3);
  EXPECT_EQ(gain.hands, 2);
  EXPECT_EQ(gain_of(results, "peak_pressure_cells_mpa", {}).hands, 0);
}

TEST(HoldGains, SayWhereTheGainIsGone) {
  HoldGains gains;
  gains.quantities = {study::quantity_named(changed_by(0.0, 1), "peak_pressure_cells_mpa")};
  const auto at = [](double along, double change) {
    return HoldGains::AtOffset{along, {{.change = change, .hands = 9}}};
  };
  gains.offsets = {at(-12, -0.05), at(-5, -0.15), at(0, -0.2), at(5, -0.1), at(8, 0.05)};
  EXPECT_FALSE(gone_at(gains, 0, -1).has_value());
  ASSERT_TRUE(gone_at(gains, 0, 1).has_value());
  EXPECT_NEAR(*gone_at(gains, 0, 1), 7.0, 1e-9);  // from -0.1 at 5 mm to 0.05 at 8 mm
  gains.offsets[2] = at(0, 0.01);
  EXPECT_EQ(gone_at(gains, 0, 1), 0.0);
}

}  // namespace
}  // namespace palmar::workflow
