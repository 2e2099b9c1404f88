// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "study/study_comparison_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "palmar/core/version.h"
#include "palmar/report/study/study_words.h"
#include "palmar/study/statistics/study_analysis.h"

namespace palmar::cli {
namespace {

using Json = nlohmann::ordered_json;

Json interval_object(const Interval& interval) { return {interval.low, interval.high}; }

Json pair_object(const StudyPlan& plan, const ProductPair& pair) {
  const auto name = [&](int product) {
    return plan.products[static_cast<std::size_t>(product)].name;
  };
  Json left_out = Json::array();
  for (const LeftOutHands& one : pair.left_out) {
    left_out.push_back(
        {{"product", name(one.product)}, {"cause", one.cause}, {"hands", one.hands}});
  }
  Json object = {{"first", name(pair.first)}, {"second", name(pair.second)},
                 {"hands", pair.hands},       {"pairs", pair.pairs},
                 {"left_out", left_out},      {"verdict", name_of(pair.verdict)}};
  if (pair.verdict == DifferenceVerdict::kTooFewPairs) return object;
  const PairedTest& t = pair.t_test;
  object["mean_first"] = pair.mean_first;
  object["mean_second"] = pair.mean_second;
  object["difference"] = t.difference;
  object["difference_interval_95"] = interval_object(t.interval);
  object["t_test"] = {
      {"t", t.t}, {"df", t.df}, {"p_value", t.p_value}, {"p_value_holm", pair.t_p_holm}};
  object["wilcoxon"] = {{"v", pair.wilcoxon.v},
                        {"is_exact", pair.wilcoxon.is_exact},
                        {"p_value", pair.wilcoxon.p_value},
                        {"p_value_holm", pair.wilcoxon_p_holm}};
  object["cohen_dz"] = t.effect_size;
  object["cohen_dz_interval_95"] = interval_object(t.effect_interval);
  return object;
}

Json product_object(const StudyResults& results, const StudyQuantity& quantity,
                    const StudyCondition& condition, int product) {
  const ProductStatistics statistics = product_statistics(results, {quantity}, condition, product);
  Json outcomes = Json::object();
  for (int k = 0; k < kStudyOutcomes; ++k) {
    const int hands = statistics.outcomes.of[static_cast<std::size_t>(k)];
    if (hands > 0) outcomes[name_of(static_cast<StudyOutcome>(k))] = hands;
  }
  if (statistics.outcomes.not_run > 0) outcomes["not_run"] = statistics.outcomes.not_run;
  Json object = {{"product", results.plan.products[static_cast<std::size_t>(product)].name},
                 {"outcomes", outcomes}};
  if (const QuantitySummary* one = summary_of(statistics, quantity.key)) {
    object["n"] = one->summary.n;
    object["mean"] = one->summary.mean;
    object["sd"] = one->summary.sd;
    object["median"] = one->summary.median;
    object["p5"] = one->p5;
    object["p95"] = one->p95;
  } else {
    object["n"] = 0;
  }
  return object;
}

}  // namespace

Json comparison_object(const StudyResults& results, const std::vector<StudyQuantity>& quantities,
                       const ComparisonOptions& options) {
  Json conditions = Json::array();
  for (const StudyCondition& condition : conditions_of(results.plan)) {
    Json compared = Json::array();
    for (const StudyQuantity& quantity : quantities) {
      Json products = Json::array();
      for (int p = 0; p < static_cast<int>(results.plan.products.size()); ++p) {
        products.push_back(product_object(results, quantity, condition, p));
      }
      Json pairs = Json::array();
      for (const ProductPair& pair :
           compare_products(results, condition, quantity, options).pairs) {
        pairs.push_back(pair_object(results.plan, pair));
        if (const auto forces = grip_forces(results, condition, pair.first, pair.second)) {
          pairs.back()["mean_grip_forces_n"] = {forces->first, forces->second};
        }
      }
      compared.push_back({{"quantity", quantity.key},
                          {"name", quantity.name},
                          {"unit", quantity.unit},
                          {"products", products},
                          {"pairs", pairs}});
    }
    conditions.push_back(
        {{"condition", title_of(results.plan, condition)}, {"quantities", compared}});
  }
  return {{"study", results.plan.name},
          {"significance", options.significance},
          {"conditions", conditions},
          {"palmar", version()}};
}

std::string comparison_text(const StudyResults& results,
                            const std::vector<StudyQuantity>& quantities,
                            const ComparisonOptions& options) {
  std::string text;
  for (const StudyCondition& condition : conditions_of(results.plan)) {
    text += title_of(results.plan, condition) + "\n";
    for (const StudyQuantity& quantity : quantities) {
      text +=
          fmt::format("  {}{}\n", quantity.name, quantity.unit.empty() ? "" : ", " + quantity.unit);
      std::size_t width = 7;
      for (const StudyProduct& one : results.plan.products) {
        width = std::max(width, one.name.size());
      }
      text += fmt::format("    {:<{}}  {:>5} {:>10} {:>10} {:>10} {:>10} {:>10}\n", "product",
                          width, "hands", "mean", "SD", "P5", "median", "P95");
      for (int p = 0; p < static_cast<int>(results.plan.products.size()); ++p) {
        const ProductStatistics statistics = product_statistics(results, {quantity}, condition, p);
        const std::string& name = results.plan.products[static_cast<std::size_t>(p)].name;
        const QuantitySummary* one = summary_of(statistics, quantity.key);
        if (one == nullptr) {
          text += fmt::format("    {:<{}}  {:>5}\n", name, width, 0);
          continue;
        }
        text += fmt::format("    {:<{}}  {:>5} {:>10.4g} {:>10.3g} {:>10.4g} {:>10.4g} {:>10.4g}\n",
                            name, width, one->summary.n, one->summary.mean, one->summary.sd,
                            one->p5, one->summary.median, one->p95);
      }
      for (const ProductPair& pair :
           compare_products(results, condition, quantity, options).pairs) {
        text += "    " + pair_words(results.plan, quantity, pair) + "\n";
        const std::string force = grip_force_words(results, condition, pair.first, pair.second);
        if (!force.empty()) text += "      " + force + "\n";
        const std::string left_out = left_out_words(results.plan, pair);
        if (!left_out.empty()) text += "      left out: " + left_out + "\n";
      }
    }
  }
  return text;
}

}  // namespace palmar::cli
