// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Case G3: contact area over hands of different length. Until hands are sampled, they are the
// template at different sizes.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <string>

#include "palmar/hand/dimensions.h"
#include "palmar/hand/scaled_hand.h"
#include "palmar/hand/skinning.h"
#include "palmar/study/validation_cases.h"

namespace palmar {
namespace {

constexpr int kHands = 30;
constexpr double kMeanLength = 184.0, kLengthDeviation = 10.4;  // mm; Xie 2014, section 5.5.1

/// x with a share p of a standard normal variable below it.
double normal_quantile(double p) {
  double low = -8.0, high = 8.0;
  for (int i = 0; i < 60; ++i) {
    const double x = 0.5 * (low + high);
    (0.5 * std::erfc(-x / std::sqrt(2.0)) < p ? low : high) = x;
  }
  return 0.5 * (low + high);
}

/// Value below which a share of the sorted values lies, interpolated.
double quantile(const std::vector<double>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto i = static_cast<std::size_t>(at);
  const double rest = at - static_cast<double>(i);
  return rest > 0.0 ? (1.0 - rest) * sorted[i] + rest * sorted[i + 1] : sorted[i];
}

/// Spearman's rank correlation of values with their own order, for values without ties.
double correlation_with_order(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  double sum = 0.0;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const double d = static_cast<double>(rank) - static_cast<double>(order[rank]);
    sum += d * d;
  }
  const auto n = static_cast<double>(values.size());
  return 1.0 - 6.0 * sum / (n * (n * n - 1.0));
}

void add_areas(ValidationRows& rows, const std::string& preset, const std::vector<double>& areas) {
  std::vector<double> sorted = areas;
  std::sort(sorted.begin(), sorted.end());
  const std::string source = "Xie 2014, 5.5.2: 3700 to 4000 mm2, 30 sampled hands";
  rows.push_back(judge(preset + ", median of 30 scaled templates", "mm2", quantile(sorted, 0.5),
                       between(3300.0, 4400.0, source)));
  rows.push_back(judge(preset + ", quartile range", "mm2",
                       quantile(sorted, 0.75) - quantile(sorted, 0.25), at_most(500.0, source)));
  rows.push_back(judge(preset + ", rank correlation with hand length", "",
                       correlation_with_order(areas), at_least(0.5, source)));
}

}  // namespace

ValidationRows validate_contact_area(ValidationBench& bench) {
  const HeldCylinder& template_grasp = bench.cylinder(35.0);
  const Product& product = template_grasp.product;
  const double template_length = measure_hand(bench.hand()).hand_length;
  std::vector<double> coupled, thesis;
  for (int i = 0; i < kHands; ++i) {
    const double length = kMeanLength + kLengthDeviation * normal_quantile((i + 0.5) / kHands);
    bench.update(static_cast<double>(i) / kHands,
                 "case G3, hand " + std::to_string(i + 1) + " of " + std::to_string(kHands));
    const auto hand = std::make_shared<const Hand>(scaled(bench.hand(), length / template_length));
    // The thesis' hands are as they were closed; ours come to rest.
    const Grasp closed = close_power_grasp(*hand, product);
    const auto area = [&](const PreparedHand& prepared, const Grasp& grasp) {
      return solve_hand_contact(prepared, pose_skin(*hand, grasp.posture), grasp.product_from_hand,
                                *product.distance)
          .total.area;
    };
    const PreparedHand prepared(hand);
    Grasp rest = closed;
    balance_grasp(prepared, product, rest);
    coupled.push_back(area(prepared, rest));
    thesis.push_back(area(PreparedHand(hand, xie2014_model()), closed));
  }
  ValidationRows rows;
  add_areas(rows, "palmar", coupled);
  add_areas(rows, "xie2014", thesis);
  const std::string source = "mode of 30 sampled hands, Xie 2014, 5.5.2";
  rows.push_back(judge("palmar, template as it is, length " +
                           std::to_string(static_cast<int>(std::lround(template_length))) + " mm",
                       "mm2", bench.contact(template_grasp, {}).total.area,
                       information(3875.0, source)));
  rows.push_back(not_built("30 hands sampled with their own proportions", "populations: issue 5"));
  return rows;
}

}  // namespace palmar
