// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/study/statistics/accommodation.h"
#include "palmar/study/statistics/exclusion.h"
#include "palmar/study/statistics/product_sizes.h"
#include "palmar/study/statistics/study_comparison.h"
#include "palmar/study/statistics/study_results.h"
#include "palmar/study/statistics/study_statistics.h"

namespace palmar::study {

/// Everything that is said of one condition.
struct ConditionAnalysis {
  StudyCondition condition;
  std::vector<ProductStatistics> products;      ///< by product
  std::vector<QuantityComparison> comparisons;  ///< by quantity
  std::vector<Accommodation> accommodation;     ///< by product
  std::vector<Exclusion> exclusion;             ///< by product
  std::vector<ProductSizes> sizes;              ///< by family of several sizes
};

/// All statistics of a study's results. Same results, same figures, on any number of threads.
struct StudyAnalysis {
  std::vector<StudyQuantity> quantities;
  std::vector<ConditionAnalysis> conditions;  ///< as conditions_of()
};
StudyAnalysis analyse_study(const StudyResults& results, const ComparisonOptions& options = {});
/// Of one quantity, or null.
const QuantityComparison* comparison_of(const ConditionAnalysis& analysis, const std::string& key);

/// What a reader must know before trusting the figures.
struct StudyWarning {
  bool is_outside = false;  ///< outside what was checked, or hands are missing; else a caution
  std::string subject;      ///< "Population thesis"
  std::string text;         ///< a sentence, the value and what was checked in it
};
/// Depths beyond those the tissue was fitted to; hands much larger or smaller than the template;
/// products thinner or thicker than those that were checked; grasps that slip, fail, don't come to
/// rest or weren't run; hands that hold a product in different ways or by fewer parts than their
/// grip needs; products held at different grip forces; hands that aren't
/// drawn by chance; less strength without a load; few hands; what the populations say of
/// themselves. Those outside first.
std::vector<StudyWarning> study_warnings(const StudyResults& results,
                                         const std::vector<product::Product>& products,
                                         const hand::HandDimensions& base);

}  // namespace palmar::study
