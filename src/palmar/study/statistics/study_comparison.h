// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/statistics/paired_test.h"
#include "palmar/study/statistics/study_results.h"

namespace palmar::study {

struct ComparisonOptions {
  double level = 0.95;         ///< of intervals
  double significance = 0.05;  ///< p values, corrected, below it name a difference
  void check() const;          ///< throws UsageError: field, value, allowed range
};

/// Hands that don't take part in a comparison because of one product. A hand that both products
/// leave out is counted with both.
struct LeftOutHands {
  int product = 0;
  std::string cause;  ///< name of the outcome, "not_run", or "no_value"
  int hands = 0;
};

enum class DifferenceVerdict {
  kTooFewPairs,  ///< fewer than 2: no test
  kNone,         ///< not one pair differs
  kNotShown,     ///< p, corrected, is not below `significance`
  kShown
};
std::string name_of(DifferenceVerdict verdict);  ///< "too_few_pairs", "none", "not_shown", "shown"

/// One quantity of two products over the same hands. Differences are second - first.
struct ProductPair {
  int first = 0, second = 0;   ///< products
  int hands = 0;               ///< of the condition
  int pairs = 0;               ///< hands with a value of both
  int lower_in_second = 0;     ///< of them those in which the second has the lower value
  std::vector<double> change;  ///< of each of them: second over first, less 1; 0 where first is 0
  std::vector<LeftOutHands> left_out;
  double mean_first = 0.0, mean_second = 0.0;  ///< over the pairs
  statistics::PairedTest t_test;               ///< Student's, as in the thesis; the verdict's
  statistics::SignedRankTest wilcoxon;         ///< beside it: needs no normal differences
  double t_p_holm = 1.0, wilcoxon_p_holm = 1.0;
  DifferenceVerdict verdict = DifferenceVerdict::kTooFewPairs;
};

/// All pairs of products of one quantity under one condition; p values are corrected after Holm
/// over these pairs.
struct QuantityComparison {
  StudyCondition condition;
  StudyQuantity quantity;
  std::vector<ProductPair> pairs;  ///< by first, then second
};
QuantityComparison compare_products(const StudyResults& results, const StudyCondition& condition,
                                    const StudyQuantity& quantity,
                                    const ComparisonOptions& options = {});

/// Mean grip forces with which the same hands hold two products, N.
struct GripForces {
  double first = 0.0, second = 0.0;
  bool are_of_task = false;  ///< each what the same task asks for (grasp::says_how_firmly())
  /// Apart by more than a tenth of the larger: pressures then differ by the force, too.
  bool are_apart() const;
  /// Apart, and not because the task asks for it: pressures can't be compared.
  bool are_unequal() const { return are_apart() && !are_of_task; }
};
/// Over the hands whose grip force is known with both; nothing if there is none.
std::optional<GripForces> grip_forces(const StudyResults& results, const StudyCondition& condition,
                                      int first, int second);

}  // namespace palmar::study
