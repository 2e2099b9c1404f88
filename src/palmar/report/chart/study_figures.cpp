// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/chart/study_figures.h"

#include <algorithm>

#include "palmar/report/chart/study_charts.h"
#include "palmar/report/words/plain_words.h"
#include "palmar/report/words/study_words.h"

namespace palmar::report {
namespace {

constexpr std::size_t kMostBracketed = 4;  // products whose every pair has a bracket
constexpr int kLinePoints = 24;

std::string with_unit(const std::string& name, const std::string& unit) {
  return capitalised(name) + (unit.empty() ? "" : ", " + unit);
}

std::vector<ChartBracket> brackets_of(const study::QuantityComparison& comparison,
                                      std::size_t products) {
  // With many products: those of the lowest mean against the others.
  int lowest = -1;
  double least = 0.0;
  for (const study::ProductPair& pair : comparison.pairs) {
    if (pair.pairs == 0) continue;
    for (const auto& [product, mean] :
         {std::pair{pair.first, pair.mean_first}, std::pair{pair.second, pair.mean_second}}) {
      if (lowest < 0 || mean < least) {
        lowest = product;
        least = mean;
      }
    }
  }
  std::vector<ChartBracket> brackets;
  for (const study::ProductPair& pair : comparison.pairs) {
    if (pair.verdict == study::DifferenceVerdict::kTooFewPairs) continue;
    if (products > kMostBracketed && pair.first != lowest && pair.second != lowest) continue;
    const bool is_shown = pair.verdict == study::DifferenceVerdict::kShown;
    brackets.push_back(
        {pair.first, pair.second,
         pair.verdict == study::DifferenceVerdict::kNone ? "same" : p_words(pair.t_p_holm),
         is_shown});
  }
  return brackets;
}

Figure distribution(const study::StudyResults& results, const study::ConditionAnalysis& one,
                    const study::QuantityComparison& comparison, const std::string& which) {
  const study::StudyQuantity& quantity = comparison.quantity;
  DistributionChart chart;
  chart.title = capitalised(which + quantity.name);
  chart.x_label = with_unit(quantity.name, quantity.unit);
  for (std::size_t p = 0; p < results.plan.products.size(); ++p) {
    ChartSample sample{results.plan.products[p].name, product_colour(static_cast<int>(p)), {}};
    for (const study::HandValue& value :
         study::values_of(results, one.condition, static_cast<int>(p), quantity.key)) {
      sample.values.push_back(value.value);
    }
    chart.samples.push_back(std::move(sample));
  }
  if (study::is_drawn_by_chance(results.plan))
    chart.brackets = brackets_of(comparison, results.plan.products.size());
  return distribution_figure(chart);
}

Figure trend(const study::StudyResults& results, const study::ConditionAnalysis& one,
             const study::StudyQuantity& quantity, hand::HandDimension dimension,
             const std::string& which) {
  const bool is_length = dimension == study::kHandLength;
  const std::string size = is_length ? "hand length" : "hand circumference";
  TrendChart chart;
  chart.title = capitalised(which + quantity.name + " and " + size);
  chart.x_label = capitalised(size) + ", mm";
  chart.y_label = with_unit(quantity.name, quantity.unit);
  for (std::size_t p = 0; p < results.plan.products.size(); ++p) {
    const auto found = study::size_dependence(results, one.condition, static_cast<int>(p),
                                              quantity.key, dimension);
    if (!found) continue;
    TrendSample sample{
        {results.plan.products[p].name, product_colour(static_cast<int>(p)), found->value},
        found->size,
        {}};
    const auto [low, high] = std::minmax_element(found->size.begin(), found->size.end());
    for (int k = 0; k <= kLinePoints; ++k) {
      const double x = *low + (*high - *low) * k / kLinePoints;
      const statistics::Band band = statistics::confidence_band(found->fit, x);
      sample.line.push_back({x, band.value, band.low, band.high});
    }
    chart.samples.push_back(std::move(sample));
  }
  return trend_figure(chart);
}

Figure shares(const study::StudyResults& results, const study::ConditionAnalysis& one,
              const std::string& which) {
  std::vector<ShareBar> bars;
  for (const study::Accommodation& a : one.accommodation) {
    bars.push_back({results.plan.products[static_cast<std::size_t>(a.product)].name,
                    product_colour(a.product), a.inside.share, a.inside.interval.low,
                    a.inside.interval.high,
                    std::to_string(a.inside.count) + " of " + std::to_string(a.inside.n)});
  }
  const std::string title = results.plan.limits.empty() ? "hands that hold the product"
                                                        : "hands inside the stated limits";
  return share_figure(capitalised(which + title), "Share of hands (line: 95 % interval), %", bars);
}

}  // namespace

const std::vector<std::string>& main_quantities() {
  static const std::vector<std::string> keys = {"peak_pressure_cells_mpa", "peak_pressure_mpa",
                                                "mean_pressure_mpa", "contact_area_mm2", "force_n"};
  return keys;
}

std::vector<StudyFigure> study_figures(const study::StudyResults& results,
                                       const study::StudyAnalysis& analysis) {
  std::vector<StudyFigure> figures;
  for (std::size_t c = 0; c < analysis.conditions.size(); ++c) {
    const study::ConditionAnalysis& one = analysis.conditions[c];
    const bool is_only = analysis.conditions.size() == 1;
    const std::string prefix = is_only ? "" : "condition" + std::to_string(c + 1) + "_";
    const std::string which = is_only ? "" : condition_words(results.plan, one.condition) + ": ";
    const auto keep = [&](const std::string& name, const std::string& description, Figure figure) {
      figures.push_back({prefix + name, description, static_cast<int>(c), std::move(figure)});
    };
    for (const std::string& key : main_quantities()) {
      const study::QuantityComparison* comparison = study::comparison_of(one, key);
      if (comparison == nullptr) continue;
      keep(key, "Distribution of the " + comparison->quantity.name + " over hands, by product.",
           distribution(results, one, *comparison, which));
    }
    for (const std::string& key : {main_quantities()[0], main_quantities()[3]}) {
      const study::QuantityComparison* comparison = study::comparison_of(one, key);
      if (comparison == nullptr) continue;
      for (const hand::HandDimension dimension : {study::kHandLength, study::kHandCircumference}) {
        const std::string size = dimension == study::kHandLength ? "length" : "circumference";
        const bool is_known = std::any_of(results.plan.hands.begin(), results.plan.hands.end(),
                                          [&](const study::StudyHand& hand) {
                                            return study::size_of(hand, dimension).has_value();
                                          });
        if (!is_known) continue;
        keep(key + "_by_hand_" + size,
             "The " + comparison->quantity.name + " against the hand's " + size +
                 ", with regression lines and their 95 % bands.",
             trend(results, one, comparison->quantity, dimension, which));
      }
    }
    keep("accommodation", "Share of hands that each product suits.", shares(results, one, which));
  }
  return figures;
}

}  // namespace palmar::report
