// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "palmar/statistics/linear_fit.h"
#include "palmar/statistics/summary.h"
#include "palmar/study/statistics/study_results.h"

namespace palmar::study {

/// A quantity of one product over the hands that held it, in the quantity's unit.
struct QuantitySummary {
  StudyQuantity quantity;
  statistics::Summary summary;
  double p5 = 0.0, p95 = 0.0;  ///< percentiles (type 7)
};

/// One region of the hand over the hands that held the product. Where a hand doesn't touch with the
/// region, its force, area and pressures there are 0 and count as such.
struct RegionSummary {
  hand::Region region{};
  int touching = 0;                  ///< hands
  double force = 0.0;                ///< mean, N
  double force_sd = 0.0;             ///< N
  double area = 0.0;                 ///< mean, mm^2
  double peak_pressure_cells = 0.0;  ///< mean, MPa
  double largest_peak_cells = 0.0;   ///< of any hand, MPa
};

/// One product under one condition. How hands ended that don't take part in the figures stands in
/// `outcomes`: nobody is dropped unseen.
struct ProductStatistics {
  StudyCondition condition;
  int product = 0;
  OutcomeCounts outcomes;
  int unbalanced = 0;                       ///< in the hand, but not brought to rest
  std::vector<QuantitySummary> quantities;  ///< those with a value, in the order of quantities_of()
  std::vector<RegionSummary> regions;       ///< touched by anybody, ascending
};

/// Of every condition and product, conditions first.
std::vector<ProductStatistics> study_statistics(const StudyResults& results);
ProductStatistics product_statistics(const StudyResults& results,
                                     const std::vector<StudyQuantity>& quantities,
                                     const StudyCondition& condition, int product);
/// The summary of a quantity, or null if no hand has a value.
const QuantitySummary* summary_of(const ProductStatistics& statistics, const std::string& key);

/// A value with whose it is.
struct HandValue {
  int hand = 0;  ///< index into plan.hands
  double value = 0.0;
};
/// Values of a quantity, ascending by hand; hands without one are left out.
std::vector<HandValue> values_of(const StudyResults& results, const StudyCondition& condition,
                                 int product, const std::string& key);

/// How a quantity goes with the size of the hand: value = intercept + slope * size.
struct SizeDependence {
  hand::HandDimension dimension;  ///< hand length or circumference
  std::vector<int> hand;
  std::vector<double> size, value;  ///< mm and the quantity's unit, by hand
  statistics::LinearFit fit;
  double rank_correlation = 0.0;  ///< Spearman's, ties share their mean rank
};
/// Nothing with fewer than 3 hands, hands of one size, or a size that the population doesn't say.
std::optional<SizeDependence> size_dependence(const StudyResults& results,
                                              const StudyCondition& condition, int product,
                                              const std::string& key,
                                              hand::HandDimension dimension);

inline constexpr hand::HandDimension kHandLength{hand::DimensionKind::kHandLength,
                                                 hand::Segment::kPalm};
inline constexpr hand::HandDimension kHandCircumference{hand::DimensionKind::kHandCircumference,
                                                        hand::Segment::kPalm};

}  // namespace palmar::study
