// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/statistics/proportion.h"
#include "palmar/study/statistics/study_results.h"

namespace palmar::study {

/// What one size of a choice is for.
struct ServedBySize {
  int product = 0;
  int inside = 0;  ///< hands inside the limits with this size
  int alone = 0;   ///< of them, those that no other size of the choice serves
  /// Of a size table by hand length, mm: who takes this size. An unset end is open. A size that
  /// nobody should take by length alone has `is_taken` false.
  bool is_taken = false;
  std::optional<double> from, to;
};

/// The best so many sizes of a product.
struct SizeChoice {
  std::vector<ServedBySize> sizes;  ///< ascending by size
  /// Hands that at least one of the sizes serves: everybody tries all on.
  statistics::Proportion served;
  /// Hands that the size of the table serves: everybody goes by hand length. Bounds of the table
  /// are those that serve most of these hands; equal lengths take equal sizes. Of hands whose
  /// length is known.
  statistics::Proportion served_by_length;
};

/// How many sizes a product needs and for whom.
struct ProductSizes {
  StudyCondition condition;
  std::string family;
  int hands = 0;                    ///< of which every size was run
  std::vector<SizeChoice> choices;  ///< the best 1, 2, ... at most `most` sizes
};

/// For every family of two or more sizes: every subset of 1 to `most` sizes is tried and that which
/// serves most hands (is_inside() the limits) kept; among equals the one that serves most by hand
/// length, then the one with the smaller sizes. Hands for which a size wasn't run take no part.
/// Throws UsageError unless 1 <= most <= 4.
std::vector<ProductSizes> product_sizes(const StudyResults& results,
                                        const StudyCondition& condition, int most = 3);

}  // namespace palmar::study
