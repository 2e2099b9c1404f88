// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/statistics/study_comparison.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/study/statistics/study_analysis.h"
#include "palmar/study/statistics/study_test_results.h"

namespace palmar::study {
namespace {

using testing::held;
using testing::not_held;
using testing::study_of;

const StudyQuantity kPeak = hand_quantities().front();

/// Six hands, three products, peaks as in the R code below.
StudyResults three_products() {
  StudyResults results = study_of(6, {"a", "b", "c"});
  const double peaks[3][6] = {{0.41, 0.39, 0.44, 0.47, 0.40, 0.38},
                              {0.30, 0.33, 0.31, 0.38, 0.29, 0.30},
                              {0.31, 0.30, 0.33, 0.36, 0.31, 0.31}};
  for (int h = 0; h < 6; ++h) {
    for (int p = 0; p < 3; ++p) results.records.push_back(held(3 * h + p, peaks[p][h]));
  }
  return results;
}

TEST(CompareProducts, AgreesWithRAfterHolm) {
  // R 4.2: a <- c(0.41, ...); p <- c(t.test(b, a, paired = TRUE)$p.value, (c, a), (c, b));
  // p.adjust(p, "holm"); wilcox.test(b, a, paired = TRUE, exact = TRUE)$p.value
  const QuantityComparison found = compare_products(three_products(), {}, kPeak);
  ASSERT_EQ(found.pairs.size(), 3U);
  EXPECT_NEAR(found.pairs[0].t_test.p_value, 2.23090911266255e-04, 1e-13);
  EXPECT_NEAR(found.pairs[1].t_test.p_value, 2.13335738761664e-05, 1e-14);
  EXPECT_NEAR(found.pairs[2].t_test.p_value, 8.56009234067152e-01, 1e-9);
  EXPECT_NEAR(found.pairs[0].t_p_holm, 4.46181822532510e-04, 1e-13);
  EXPECT_NEAR(found.pairs[1].t_p_holm, 6.40007216284993e-05, 1e-13);
  EXPECT_NEAR(found.pairs[2].t_p_holm, 8.56009234067152e-01, 1e-9);
  EXPECT_NEAR(found.pairs[0].wilcoxon.p_value, 0.03125, 1e-12);
  EXPECT_NEAR(found.pairs[1].wilcoxon.p_value, 0.0350149810196625, 1e-9);
  EXPECT_NEAR(found.pairs[0].t_test.interval.low, -0.1229375155623135, 1e-9);  // MPa
  EXPECT_NEAR(found.pairs[0].t_test.interval.high, -0.0703958177710199, 1e-9);
  EXPECT_NEAR(found.pairs[0].t_test.effect_size, -3.86152139936198, 1e-9);
  EXPECT_EQ(found.pairs[0].verdict, DifferenceVerdict::kShown);
  EXPECT_EQ(found.pairs[2].verdict, DifferenceVerdict::kNotShown);
}

TEST(CompareProducts, HandsWithoutBothAreCountedWithTheirCause) {
  // R: t.test(b[-3], a[-3], paired = TRUE)$p.value
  StudyResults results = three_products();
  results.records[3 * 2 + 1] = not_held(3 * 2 + 1, StudyOutcome::kSlipsOut);
  results.records.erase(results.records.begin() + 3 * 4 + 2);  // hand 4 didn't take product c
  results.records.back().force = 0.0;                          // held by name, without contact
  const QuantityComparison found = compare_products(results, {}, kPeak);
  const ProductPair& ab = found.pairs[0];
  EXPECT_EQ(ab.hands, 6);
  EXPECT_EQ(ab.pairs, 5);
  EXPECT_NEAR(ab.t_test.p_value, 0.000688909364939612, 1e-12);
  ASSERT_EQ(ab.left_out.size(), 1U);
  EXPECT_EQ(ab.left_out[0].product, 1);
  EXPECT_EQ(ab.left_out[0].cause, "slips_out");
  EXPECT_EQ(ab.left_out[0].hands, 1);
  const ProductPair& bc = found.pairs[2];
  EXPECT_EQ(bc.pairs, 3);
  ASSERT_EQ(bc.left_out.size(), 3U);
  EXPECT_EQ(bc.left_out[1].cause, "no_value");
  EXPECT_EQ(bc.left_out[2].cause, "not_run");
}

TEST(CompareProducts, AProductDoesNotDifferFromItself) {
  StudyResults results = study_of(6, {"a", "same as a"});
  const double peaks[6] = {0.41, 0.39, 0.44, 0.47, 0.40, 0.38};
  for (int h = 0; h < 6; ++h) {
    for (int p = 0; p < 2; ++p) results.records.push_back(held(2 * h + p, peaks[h]));
  }
  const ProductPair pair = compare_products(results, {}, kPeak).pairs.front();
  EXPECT_EQ(pair.verdict, DifferenceVerdict::kNone);
  EXPECT_EQ(pair.t_p_holm, 1.0);
  EXPECT_EQ(pair.wilcoxon_p_holm, 1.0);
  EXPECT_EQ(pair.t_test.difference, 0.0);
}

// Six activations at the cap, to which an iteration came within 1e-14.
TEST(CompareProducts, RoundingIsNoDifference) {
  StudyResults results = study_of(6, {"a", "b"});
  for (int h = 0; h < 6; ++h) {
    results.records.push_back(held(2 * h, 1.0));
    results.records.push_back(held(2 * h + 1, 1.0 - 1e-14 * (h + 1)));
  }
  const QuantityComparison found = compare_products(results, {}, kPeak);
  EXPECT_EQ(found.pairs[0].verdict, DifferenceVerdict::kNone);
  EXPECT_TRUE(found.pairs[0].t_test.is_constant);
  EXPECT_EQ(found.pairs[0].wilcoxon.n_used, 0);
}

TEST(CompareProducts, SwappingProductsTurnsTheSignAlone) {
  StudyResults swapped = three_products();
  for (StudyRecord& record : swapped.records) {
    if (record.number % 3 < 2) record.number += record.number % 3 == 0 ? 1 : -1;
  }
  std::sort(swapped.records.begin(), swapped.records.end(),
            [](const auto& one, const auto& other) { return one.number < other.number; });
  const ProductPair before = compare_products(three_products(), {}, kPeak).pairs[0];
  const ProductPair after = compare_products(swapped, {}, kPeak).pairs[0];
  EXPECT_DOUBLE_EQ(before.t_test.difference, -after.t_test.difference);
  EXPECT_NEAR(before.t_test.p_value, after.t_test.p_value, 1e-15);
  EXPECT_DOUBLE_EQ(before.t_test.effect_size, -after.t_test.effect_size);
}

TEST(CompareProducts, OneHandIsTooFew) {
  StudyResults results = study_of(1, {"a", "b"});
  results.records = {held(0, 0.2), held(1, 0.3)};
  const ProductPair pair = compare_products(results, {}, kPeak).pairs.front();
  EXPECT_EQ(pair.verdict, DifferenceVerdict::kTooFewPairs);
  EXPECT_DOUBLE_EQ(pair.mean_second, 0.3);
}

TEST(CompareProducts, RefusesASignificanceOfZero) {
  ComparisonOptions options;
  options.significance = 0.0;
  try {
    compare_products(three_products(), {}, kPeak, options);
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(), "comparison: significance is 0; between 0 and 1 is required");
  }
}

TEST(AnalyseStudy, OrderOfHandsAndThreadsChangeNothing) {
  const StudyResults results = three_products();
  // The same people in another order.
  StudyResults other = results;
  std::reverse(other.plan.hands.begin(), other.plan.hands.end());
  for (StudyRecord& record : other.records) {
    record.number = 3 * (5 - record.number / 3) + record.number % 3;
  }
  std::sort(other.records.begin(), other.records.end(),
            [](const auto& one, const auto& two) { return one.number < two.number; });
  set_thread_count(1);
  const StudyAnalysis single = analyse_study(results);
  set_thread_count(0);
  const StudyAnalysis many = analyse_study(results);
  const StudyAnalysis turned = analyse_study(other);
  ASSERT_EQ(single.conditions.size(), 1U);
  for (std::size_t q = 0; q < single.quantities.size(); ++q) {
    for (std::size_t k = 0; k < 3; ++k) {
      const ProductPair& one = single.conditions[0].comparisons[q].pairs[k];
      const ProductPair& two = many.conditions[0].comparisons[q].pairs[k];
      const ProductPair& three = turned.conditions[0].comparisons[q].pairs[k];
      EXPECT_EQ(one.t_p_holm, two.t_p_holm);
      EXPECT_EQ(one.wilcoxon_p_holm, two.wilcoxon_p_holm);
      EXPECT_NEAR(one.t_p_holm, three.t_p_holm, 1e-12);  // sums in another order
      EXPECT_EQ(one.verdict, three.verdict);
    }
  }
}

TEST(StudyWarnings, NameWhatIsOutsideTheChecks) {
  StudyResults results = three_products();
  results.plan.settings[0].palm_limit_depth = 9.0;
  results.plan.populations[0].population.cautions = {"Mixes the sexes."};
  results.records.pop_back();
  results.records[0] = not_held(0, StudyOutcome::kSlipsOut);
  results.records[2].fallbacks.by_region = 1;
  results.records[3].fallbacks.by_region = 2;
  hand::HandDimensions base;
  base.hand_length = 190.0;
  const std::vector<StudyWarning> warnings = study_warnings(results, {}, base);
  const auto has = [&](const std::string& subject, const std::string& words, bool is_outside) {
    return std::any_of(warnings.begin(), warnings.end(), [&](const StudyWarning& one) {
      return one.subject == subject && one.is_outside == is_outside &&
             one.text.find(words) != std::string::npos;
    });
  };
  EXPECT_TRUE(has("Setting default", "up to 9 mm; the tissue was fitted up to 7 mm", true));
  EXPECT_TRUE(has("a", "1 of 6 grasps slip out", true));
  EXPECT_TRUE(has("c", "1 of 6 grasps were not run yet", true));
  EXPECT_TRUE(has("Population people1", "Mixes the sexes.", false));
  EXPECT_TRUE(
      has("Contact solver", "3 problems were solved region by region, in 2 of 17 grasps", false));
  EXPECT_FALSE(has("Contact solver", "Lemke", false));
  EXPECT_TRUE(has("Population people1", "6 hands are few", false));
}

}  // namespace
}  // namespace palmar::study
