// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/statistics/study_statistics.h"

#include <algorithm>
#include <map>

#include "palmar/statistics/correlation.h"

namespace palmar::study {
namespace {

std::vector<const StudyRecord*> records_in_hand(const StudyResults& results,
                                                const StudyCondition& condition, int product) {
  std::vector<const StudyRecord*> records;
  for (const int hand : hands_of(results.plan, condition)) {
    const StudyRecord* record = record_of(results, condition, product, hand);
    if (record != nullptr && is_in_hand(*record)) records.push_back(record);
  }
  return records;
}

std::vector<RegionSummary> region_summaries(const std::vector<const StudyRecord*>& records) {
  std::map<hand::Region, std::vector<const RegionRecord*>> touched;
  for (const StudyRecord* record : records) {
    for (const RegionRecord& one : record->regions) touched[one.region].push_back(&one);
  }
  std::vector<RegionSummary> summaries;
  const auto count = static_cast<double>(records.size());
  for (const auto& [region, rows] : touched) {
    RegionSummary summary;
    summary.region = region;
    summary.touching = static_cast<int>(rows.size());
    std::vector<double> force(records.size(), 0.0);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      force[i] = rows[i]->force;
      summary.area += rows[i]->area / count;
      summary.peak_pressure_cells += rows[i]->peak_pressure_cells / count;
      summary.largest_peak_cells =
          std::max(summary.largest_peak_cells, rows[i]->peak_pressure_cells);
    }
    const statistics::Summary forces = statistics::summarise(force);
    summary.force = forces.mean;
    summary.force_sd = forces.sd;
    summaries.push_back(summary);
  }
  return summaries;
}

}  // namespace

ProductStatistics product_statistics(const StudyResults& results,
                                     const std::vector<StudyQuantity>& quantities,
                                     const StudyCondition& condition, int product) {
  ProductStatistics statistics;
  statistics.condition = condition;
  statistics.product = product;
  statistics.outcomes = outcomes_of(results, condition, product);
  const std::vector<const StudyRecord*> records = records_in_hand(results, condition, product);
  for (const StudyRecord* record : records) statistics.unbalanced += record->is_balanced ? 0 : 1;
  for (const StudyQuantity& quantity : quantities) {
    std::vector<double> values;
    for (const StudyRecord* record : records) {
      if (const auto value = quantity_of(*record, quantity.key)) values.push_back(*value);
    }
    if (values.empty()) continue;
    QuantitySummary one{quantity, statistics::summarise(values), 0.0, 0.0};
    std::sort(values.begin(), values.end());
    one.p5 = statistics::quantile(values, 0.05);
    one.p95 = statistics::quantile(values, 0.95);
    statistics.quantities.push_back(std::move(one));
  }
  statistics.regions = region_summaries(records);
  return statistics;
}

std::vector<ProductStatistics> study_statistics(const StudyResults& results) {
  const std::vector<StudyQuantity> quantities = quantities_of(results);
  std::vector<ProductStatistics> all;
  for (const StudyCondition& condition : conditions_of(results.plan)) {
    for (int p = 0; p < static_cast<int>(results.plan.products.size()); ++p) {
      all.push_back(product_statistics(results, quantities, condition, p));
    }
  }
  return all;
}

const QuantitySummary* summary_of(const ProductStatistics& statistics, const std::string& key) {
  for (const QuantitySummary& one : statistics.quantities) {
    if (one.quantity.key == key) return &one;
  }
  return nullptr;
}

std::vector<HandValue> values_of(const StudyResults& results, const StudyCondition& condition,
                                 int product, const std::string& key) {
  std::vector<HandValue> values;
  for (const int hand : hands_of(results.plan, condition)) {
    const StudyRecord* record = record_of(results, condition, product, hand);
    if (record == nullptr) continue;
    if (const auto value = quantity_of(*record, key)) values.push_back({hand, *value});
  }
  return values;
}

std::optional<SizeDependence> size_dependence(const StudyResults& results,
                                              const StudyCondition& condition, int product,
                                              const std::string& key,
                                              hand::HandDimension dimension) {
  SizeDependence found;
  found.dimension = dimension;
  for (const HandValue& one : values_of(results, condition, product, key)) {
    if (const auto size = size_of(results.plan, condition, one.hand, dimension)) {
      found.hand.push_back(one.hand);
      found.size.push_back(*size);
      found.value.push_back(one.value);
    }
  }
  if (found.size.size() < 3 || statistics::is_constant(found.size)) return std::nullopt;
  found.fit = statistics::fit_line(found.size, found.value);
  found.rank_correlation = statistics::spearman(found.size, found.value).r;
  return found;
}

}  // namespace palmar::study
