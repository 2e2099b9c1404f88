// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/statistics/product_sizes.h"

#include <algorithm>
#include <numeric>
#include <string>

#include "palmar/core/error.h"
#include "palmar/study/statistics/accommodation.h"
#include "palmar/study/statistics/study_statistics.h"

namespace palmar::study {
namespace {

/// The sizes of one family over hands, ascending by hand length (hands of unknown length last).
struct Family {
  std::vector<int> products;                 ///< ascending by size
  std::vector<std::vector<bool>> is_inside;  ///< [size][hand]
  std::vector<double> length;                ///< of the first hands, ascending, mm
  int hands = 0;
};

Family family_of(const StudyResults& results, const StudyCondition& condition,
                 std::vector<int> products) {
  Family family;
  family.products = std::move(products);
  std::stable_sort(family.products.begin(), family.products.end(), [&](int a, int b) {
    return results.plan.products[a].size < results.plan.products[b].size;
  });
  struct Row {
    std::optional<double> length;
    std::vector<bool> is_inside;
  };
  std::vector<Row> rows;
  for (const int h : hands_of(results.plan, condition)) {
    Row row{size_of(results.plan, condition, h, kHandLength), {}};
    for (const int product : family.products) {
      const StudyRecord* record = record_of(results, condition, product, h);
      if (record == nullptr) break;
      row.is_inside.push_back(is_inside(*record, results.plan.limits));
    }
    if (row.is_inside.size() == family.products.size()) rows.push_back(std::move(row));
  }
  std::stable_sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) {
    if (a.length.has_value() != b.length.has_value()) return a.length.has_value();
    return a.length && *a.length < *b.length;
  });
  family.hands = static_cast<int>(rows.size());
  family.is_inside.resize(family.products.size());
  for (const Row& row : rows) {
    if (row.length) family.length.push_back(*row.length);
    for (std::size_t s = 0; s < row.is_inside.size(); ++s) {
      family.is_inside[s].push_back(row.is_inside[s]);
    }
  }
  return family;
}

int served_by(const Family& family, const std::vector<int>& sizes) {
  int served = 0;
  for (std::size_t h = 0; h < static_cast<std::size_t>(family.hands); ++h) {
    served +=
        std::any_of(sizes.begin(), sizes.end(), [&](int s) { return family.is_inside[s][h]; });
  }
  return served;
}

/// The size table by hand length that serves most hands.
struct SizeTable {
  int served = 0;
  std::vector<int> end;  ///< per size: hands before it take this or a smaller size
};

SizeTable best_table(const Family& family, const std::vector<int>& sizes) {
  const std::size_t n = family.length.size();
  // A bound may stand before hand i only if its length differs from the one before.
  const auto is_bound = [&](std::size_t i) {
    return i == 0 || i == n || family.length[i - 1] < family.length[i];
  };
  // best[k][i]: most hands served among the first i by the first k + 1 sizes.
  std::vector<std::vector<int>> best(sizes.size(), std::vector<int>(n + 1, 0));
  std::vector<std::vector<int>> from(sizes.size(), std::vector<int>(n + 1, 0));
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    const std::vector<bool>& inside = family.is_inside[sizes[k]];
    std::vector<int> before(n + 1, 0);
    for (std::size_t i = 0; i < n; ++i) before[i + 1] = before[i] + (inside[i] ? 1 : 0);
    int gain = k == 0 ? 0 : best[k - 1][0];
    int start = 0;
    for (std::size_t i = 0; i <= n; ++i) {
      if (k > 0 && is_bound(i) && best[k - 1][i] - before[i] > gain) {
        gain = best[k - 1][i] - before[i];
        start = static_cast<int>(i);
      }
      best[k][i] = before[i] + gain;
      from[k][i] = start;
    }
  }
  SizeTable table{sizes.empty() ? 0 : best.back()[n], std::vector<int>(sizes.size())};
  int end = static_cast<int>(n);
  for (std::size_t k = sizes.size(); k-- > 0;) {
    table.end[k] = end;
    end = from[k][end];
  }
  return table;
}

SizeChoice choice_of(const Family& family, const std::vector<int>& sizes) {
  SizeChoice choice;
  choice.served = statistics::wilson_proportion(served_by(family, sizes), family.hands);
  const SizeTable table = best_table(family, sizes);
  choice.served_by_length =
      statistics::wilson_proportion(table.served, static_cast<int>(family.length.size()));
  const auto bound = [&](int i) -> std::optional<double> {
    if (i <= 0 || i >= static_cast<int>(family.length.size())) return std::nullopt;
    return 0.5 * (family.length[i - 1] + family.length[i]);
  };
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    const int s = sizes[k];
    ServedBySize one;
    one.product = family.products[s];
    for (std::size_t h = 0; h < static_cast<std::size_t>(family.hands); ++h) {
      if (!family.is_inside[s][h]) continue;
      ++one.inside;
      one.alone += std::none_of(sizes.begin(), sizes.end(), [&](int other) {
        return other != sizes[k] && family.is_inside[other][h];
      });
    }
    const int begin = k == 0 ? 0 : table.end[k - 1];
    one.is_taken = table.end[k] > begin;
    if (one.is_taken) {
      one.from = bound(begin);
      one.to = bound(table.end[k]);
    }
    choice.sizes.push_back(one);
  }
  return choice;
}

/// Next subset of `sizes.size()` out of `count` in lexicographic order; false after the last.
bool advance(std::vector<int>& sizes, int count) {
  for (std::size_t k = sizes.size(); k-- > 0;) {
    if (sizes[k] < count - static_cast<int>(sizes.size() - k)) {
      std::iota(sizes.begin() + static_cast<std::ptrdiff_t>(k), sizes.end(), sizes[k] + 1);
      return true;
    }
  }
  return false;
}

SizeChoice best_choice(const Family& family, int how_many) {
  std::vector<int> sizes(how_many);
  std::iota(sizes.begin(), sizes.end(), 0);
  std::vector<int> best;
  int best_served = -1, best_by_length = -1;
  do {
    const int served = served_by(family, sizes);
    if (served < best_served) continue;
    const int by_length = best_table(family, sizes).served;
    if (served > best_served || by_length > best_by_length) {
      best = sizes;
      best_served = served;
      best_by_length = by_length;
    }
  } while (advance(sizes, static_cast<int>(family.products.size())));
  return choice_of(family, best);
}

}  // namespace

std::vector<ProductSizes> product_sizes(const StudyResults& results,
                                        const StudyCondition& condition, int most) {
  if (most < 1 || most > 4) {
    throw UsageError("product sizes: " + std::to_string(most) + " sizes; 1 to 4 are allowed");
  }
  std::vector<ProductSizes> all;
  std::vector<std::string> families;
  for (const StudyProduct& product : results.plan.products) {
    if (std::find(families.begin(), families.end(), product.family) == families.end()) {
      families.push_back(product.family);
    }
  }
  for (const std::string& name : families) {
    std::vector<int> products;
    for (std::size_t p = 0; p < results.plan.products.size(); ++p) {
      if (results.plan.products[p].family == name) products.push_back(static_cast<int>(p));
    }
    if (products.size() < 2) continue;
    const Family family = family_of(results, condition, products);
    ProductSizes sizes{condition, name, family.hands, {}};
    const int upto = std::min(most, static_cast<int>(products.size()));
    for (int k = 1; family.hands > 0 && k <= upto; ++k) {
      sizes.choices.push_back(best_choice(family, k));
    }
    all.push_back(std::move(sizes));
  }
  return all;
}

}  // namespace palmar::study
