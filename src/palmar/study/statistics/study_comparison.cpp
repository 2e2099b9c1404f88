// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/statistics/study_comparison.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "palmar/core/error.h"
#include "palmar/statistics/distributions.h"

namespace palmar::study {
namespace {

/// Why a hand has no value with a product, or "" if it has.
std::string cause_of_absence(const StudyRecord* record, const std::string& key) {
  if (record == nullptr) return "not_run";
  if (!is_in_hand(*record)) {
    // Held by name but without contact: as little of a value as one that is missing.
    const bool is_held =
        record->outcome == StudyOutcome::kHeld || record->outcome == StudyOutcome::kPartlyHeld;
    return is_held ? "no_value" : name_of(record->outcome);
  }
  return quantity_of(*record, key) ? "" : "no_value";
}

/// The second of two values, or the first if they are equal but for rounding: an iteration ends at
/// a cap to 1e-14 or so, and signs of such differences aren't data.
double unless_rounding(double first, double second) {
  constexpr double kRounding =
      1e-9;  // of the larger; our choice, far below what a model or a mesh decides
  const double larger = std::max(std::abs(first), std::abs(second));
  return std::abs(first - second) <= kRounding * larger ? first : second;
}

void test(const ComparisonOptions& options, const std::vector<double>& first,
          const std::vector<double>& second, ProductPair& pair) {
  if (pair.pairs == 0) return;
  pair.mean_first = statistics::summarise(first).mean;
  pair.mean_second = statistics::summarise(second).mean;
  if (pair.pairs < 2) return;
  pair.t_test = statistics::paired_t_test(second, first, options.level);
  pair.wilcoxon = statistics::wilcoxon_signed_rank(second, first, options.level);
  pair.verdict =
      pair.wilcoxon.is_constant ? DifferenceVerdict::kNone : DifferenceVerdict::kNotShown;
}

ProductPair compare_pair(const StudyResults& results, const StudyCondition& condition,
                         const std::string& key, int first, int second,
                         const ComparisonOptions& options) {
  ProductPair pair;
  pair.first = first;
  pair.second = second;
  std::vector<double> a, b;
  std::map<std::pair<int, std::string>, int> left_out;
  for (const int hand : hands_of(results.plan, condition)) {
    ++pair.hands;
    const StudyRecord* one = record_of(results, condition, first, hand);
    const StudyRecord* other = record_of(results, condition, second, hand);
    const std::string cause_one = cause_of_absence(one, key);
    const std::string cause_other = cause_of_absence(other, key);
    if (cause_one.empty() && cause_other.empty()) {
      a.push_back(*quantity_of(*one, key));
      b.push_back(unless_rounding(a.back(), *quantity_of(*other, key)));
      continue;
    }
    if (!cause_one.empty()) ++left_out[{first, cause_one}];
    if (!cause_other.empty() && second != first) ++left_out[{second, cause_other}];
  }
  for (const auto& [whose, hands] : left_out) {
    pair.left_out.push_back({whose.first, whose.second, hands});
  }
  pair.pairs = static_cast<int>(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (b[i] < a[i]) ++pair.lower_in_second;
    pair.change.push_back(a[i] != 0.0 ? b[i] / a[i] - 1.0 : 0.0);
  }
  test(options, a, b, pair);
  return pair;
}

}  // namespace

void ComparisonOptions::check() const {
  statistics::check_level(level);
  if (!(significance > 0.0 && significance < 1.0)) {
    std::ostringstream message;
    message << "comparison: significance is " << significance << "; between 0 and 1 is required";
    throw UsageError(message.str());
  }
}

std::string name_of(DifferenceVerdict verdict) {
  switch (verdict) {
    case DifferenceVerdict::kTooFewPairs:
      return "too_few_pairs";
    case DifferenceVerdict::kNone:
      return "none";
    case DifferenceVerdict::kNotShown:
      return "not_shown";
    case DifferenceVerdict::kShown:
      break;
  }
  return "shown";
}

QuantityComparison compare_products(const StudyResults& results, const StudyCondition& condition,
                                    const StudyQuantity& quantity,
                                    const ComparisonOptions& options) {
  options.check();
  QuantityComparison comparison{condition, quantity, {}};
  const auto products = static_cast<int>(results.plan.products.size());
  for (int first = 0; first < products; ++first) {
    for (int second = first + 1; second < products; ++second) {
      comparison.pairs.push_back(
          compare_pair(results, condition, quantity.key, first, second, options));
    }
  }
  std::vector<ProductPair*> tested;
  std::vector<double> t_p, wilcoxon_p;
  for (ProductPair& pair : comparison.pairs) {
    if (pair.verdict == DifferenceVerdict::kTooFewPairs) continue;
    tested.push_back(&pair);
    t_p.push_back(pair.t_test.p_value);
    wilcoxon_p.push_back(pair.wilcoxon.p_value);
  }
  const std::vector<double> t_holm = statistics::holm(t_p);
  const std::vector<double> wilcoxon_holm = statistics::holm(wilcoxon_p);
  for (std::size_t i = 0; i < tested.size(); ++i) {
    ProductPair& pair = *tested[i];
    pair.t_p_holm = t_holm[i];
    pair.wilcoxon_p_holm = wilcoxon_holm[i];
    if (pair.verdict == DifferenceVerdict::kNone) continue;
    // Differences that are all alike leave Student's test nothing to judge by; ranks still do.
    const double p = pair.t_test.is_constant ? pair.wilcoxon_p_holm : pair.t_p_holm;
    if (p < options.significance) pair.verdict = DifferenceVerdict::kShown;
  }
  return comparison;
}

bool GripForces::are_apart() const {
  return std::abs(first - second) > 0.1 * std::max(first, second);
}

std::optional<GripForces> grip_forces(const StudyResults& results, const StudyCondition& condition,
                                      int first, int second) {
  GripForces sum;
  sum.are_of_task = grasp::says_how_firmly(results.plan.settings[condition.setting].task);
  int hands = 0;
  for (const int hand : hands_of(results.plan, condition)) {
    const StudyRecord* a = record_of(results, condition, first, hand);
    const StudyRecord* b = record_of(results, condition, second, hand);
    if (a == nullptr || b == nullptr) continue;
    const auto of_a = quantity_of(*a, "grip_force_n"), of_b = quantity_of(*b, "grip_force_n");
    if (!of_a || !of_b) continue;
    sum.first += *of_a;
    sum.second += *of_b;
    ++hands;
  }
  if (hands == 0) return std::nullopt;
  return GripForces{sum.first / hands, sum.second / hands};
}

}  // namespace palmar::study
