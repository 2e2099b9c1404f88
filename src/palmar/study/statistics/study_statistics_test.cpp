// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/statistics/study_statistics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "palmar/core/error.h"
#include "palmar/study/statistics/accommodation.h"
#include "palmar/study/statistics/product_sizes.h"
#include "palmar/study/statistics/study_test_results.h"

namespace palmar::study {
namespace {

using testing::held;
using testing::not_held;
using testing::study_of;

TEST(StudyStatistics, CountsEveryHandOfTheCondition) {
  StudyResults results = study_of(5, {"a"});
  results.records = {held(0, 0.2), not_held(1, StudyOutcome::kTooLarge), held(2, 0.4),
                     not_held(3, StudyOutcome::kFailed)};
  results.records[2].is_balanced = false;
  const ProductStatistics one = study_statistics(results).front();
  EXPECT_EQ(one.outcomes.hands(), 5);
  EXPECT_EQ(one.outcomes.in_hand(), 2);
  EXPECT_EQ(one.outcomes.not_run, 1);
  EXPECT_EQ(one.outcomes.of[static_cast<int>(StudyOutcome::kFailed)], 1);
  EXPECT_EQ(one.unbalanced, 1);
  const QuantitySummary* peak = summary_of(one, "peak_pressure_cells_mpa");
  ASSERT_NE(peak, nullptr);
  EXPECT_EQ(peak->summary.n, 2);
  EXPECT_NEAR(peak->summary.mean, 0.3, 1e-15);  // MPa
}

TEST(StudyStatistics, RegionsThatAHandDoesNotTouchCountAsZero) {
  StudyResults results = study_of(2, {"a"});
  results.records = {held(0, 0.2), held(1, 0.2)};
  RegionRecord thenar;
  thenar.region = hand::Region::kThenar;
  thenar.force = 10.0;
  thenar.area = 200.0;
  results.records[0].regions = {thenar};
  const ProductStatistics one = study_statistics(results).front();
  ASSERT_EQ(one.regions.size(), 1U);
  EXPECT_EQ(one.regions[0].touching, 1);
  EXPECT_DOUBLE_EQ(one.regions[0].force, 5.0);                          // N: 10 and 0
  EXPECT_NEAR(one.regions[0].force_sd, 50.0 / std::sqrt(50.0), 1e-12);  // of 10 and 0
  EXPECT_DOUBLE_EQ(one.regions[0].area, 100.0);
}

TEST(StudyStatistics, EveryPopulationByItselfAndAllTogether) {
  StudyResults results = study_of(4, {"a"}, 2);
  results.records = {held(0, 0.1), held(1, 0.5), held(2, 0.3), held(3, 0.7)};
  const std::vector<ProductStatistics> all = study_statistics(results);
  ASSERT_EQ(all.size(), 3U);
  EXPECT_NEAR(summary_of(all[0], "peak_pressure_cells_mpa")->summary.mean, 0.4, 1e-15);
  EXPECT_NEAR(summary_of(all[1], "peak_pressure_cells_mpa")->summary.mean, 0.2, 1e-15);
  EXPECT_NEAR(summary_of(all[2], "peak_pressure_cells_mpa")->summary.mean, 0.6, 1e-15);
  EXPECT_EQ(title_of(results.plan, all[1].condition), "people1");
}

TEST(SizeDependence, FindsTheLineThatIsThere) {
  StudyResults results = study_of(8, {"a"});
  for (int h = 0; h < 8; ++h) results.records.push_back(held(h, 0.1 + 0.002 * (160 + 2 * h)));
  const auto found = size_dependence(results, {}, 0, "peak_pressure_cells_mpa", kHandLength);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->fit.slopes[0].estimate, 0.002, 1e-12);  // MPa/mm
  EXPECT_NEAR(found->rank_correlation, 1.0, 1e-12);
  results.plan.hands[3].sample.dimensions.clear();
  EXPECT_EQ(size_dependence(results, {}, 0, "peak_pressure_cells_mpa", kHandLength)->fit.n, 7);
}

TEST(StudyResultsCheck, NamesRecordsOutOfOrderAndOutsideThePlan) {
  StudyResults results = study_of(2, {"a"});
  results.records = {held(1, 0.1), held(0, 0.1)};
  EXPECT_THROW(results.check(), UsageError);
  results.records = {held(2, 0.1)};
  try {
    results.check();
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(), "study results: record of task 2 in a plan of 2 tasks");
  }
}

TEST(QuantityNamed, OffersTheNearestKey) {
  StudyResults results = study_of(1, {"a"});
  results.records = {held(0, 0.2)};
  try {
    quantity_named(results, "peak_presure_cells_mpa");
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(),
                 "quantity \"peak_presure_cells_mpa\" is not in this study; did you mean "
                 "peak_pressure_cells_mpa?");
  }
}

TEST(Accommodation, SharesAndCausesByHand) {
  // 10 hands: 6 inside, 2 with too high a peak, 1 slips out, 1 wasn't run.
  StudyResults results = study_of(10, {"a"});
  results.plan.limits = {{"peak_pressure_cells_mpa", std::nullopt, 0.3}};
  for (int h = 0; h < 6; ++h) results.records.push_back(held(h, h == 5 ? 0.3 : 0.2));
  results.records.push_back(held(6, 0.31));
  results.records.push_back(held(7, 0.5));
  results.records.push_back(not_held(8, StudyOutcome::kSlipsOut));
  const Accommodation found = accommodation_of(results, {}, 0);
  EXPECT_EQ(found.not_run, 1);
  EXPECT_EQ(found.in_hand.count, 8);
  EXPECT_EQ(found.inside.count, 6);
  EXPECT_EQ(found.inside.n, 9);
  ASSERT_EQ(found.causes.size(), 2U);
  EXPECT_EQ(found.causes[0].cause, "peak_pressure_cells_mpa above 0.3");
  EXPECT_EQ(found.causes[0].hands, 2);
  EXPECT_EQ(found.causes[1].cause, "slips_out");
  EXPECT_EQ(found.shortest_outside, 172.0);  // mm; hands 6, 7, 8
  EXPECT_EQ(found.longest_outside, 176.0);
  EXPECT_EQ(words_of(results, results.plan.limits[0]),
            "peak pressure on sensor cells at most 0.3 MPa");
}

/// Size s of three suits hands whose length lies within 9 mm of 168, 188, 208 mm.
StudyResults three_sizes() {
  StudyResults results = study_of(31, {"S", "M", "L"});  // 160 to 220 mm
  for (int p = 0; p < 3; ++p) {
    results.plan.products[p].family = "handle";
    results.plan.products[p].size = 0.9 + 0.1 * p;
  }
  results.plan.limits = {{"peak_pressure_cells_mpa", std::nullopt, 0.3}};
  for (int h = 0; h < 31; ++h) {
    for (int p = 0; p < 3; ++p) {
      const double off = std::abs(160.0 + 2.0 * h - (168.0 + 20.0 * p));
      results.records.push_back(held(3 * h + p, off <= 9.0 ? 0.2 : 0.4));
    }
  }
  return results;
}

TEST(ProductSizes, FindsTheBestSizesAndTheirBounds) {
  // Whom each size serves: S 160-176 (9 hands), M 180-196 (9), L 200-216 (9); 4 of 31 nobody's.
  const std::vector<ProductSizes> found = product_sizes(three_sizes(), {});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].family, "handle");
  EXPECT_EQ(found[0].hands, 31);
  ASSERT_EQ(found[0].choices.size(), 3U);
  EXPECT_EQ(found[0].choices[0].served.count, 9);
  EXPECT_EQ(found[0].choices[0].sizes[0].product, 0);  // the smallest among equals
  EXPECT_EQ(found[0].choices[1].served.count, 18);
  const SizeChoice& all = found[0].choices[2];
  EXPECT_EQ(all.served.count, 27);
  EXPECT_EQ(all.served_by_length.count, 27);
  ASSERT_EQ(all.sizes.size(), 3U);
  EXPECT_FALSE(all.sizes[0].from);
  // A bound stands between the last hand of one size and the first of the next.
  ASSERT_TRUE(all.sizes[0].to && all.sizes[1].from);
  EXPECT_EQ(*all.sizes[0].to, *all.sizes[1].from);
  EXPECT_GE(*all.sizes[0].to, 176.0);
  EXPECT_LE(*all.sizes[0].to, 180.0);
  EXPECT_GE(*all.sizes[1].to, 196.0);
  EXPECT_LE(*all.sizes[1].to, 200.0);
  EXPECT_FALSE(all.sizes[2].to);
  EXPECT_EQ(all.sizes[1].alone, 9);
}

TEST(ProductSizes, MoreSizesNeverServeFewer) {
  StudyResults results = three_sizes();
  for (std::size_t i = 0; i < results.records.size(); i += 4) {
    results.records[i].peak_pressure_cells = 0.25;  // breaks the pattern
  }
  const std::vector<SizeChoice> choices = product_sizes(results, {})[0].choices;
  for (std::size_t k = 0; k < choices.size(); ++k) {
    EXPECT_LE(choices[k].served_by_length.count, choices[k].served.count);
    if (k == 0) continue;
    EXPECT_GE(choices[k].served.count, choices[k - 1].served.count);
  }
}

TEST(ProductSizes, HandsWithoutEverySizeTakeNoPart) {
  StudyResults results = three_sizes();
  results.records.pop_back();
  EXPECT_EQ(product_sizes(results, {})[0].hands, 30);
  EXPECT_THROW(product_sizes(results, {}, 0), UsageError);
}

}  // namespace
}  // namespace palmar::study
