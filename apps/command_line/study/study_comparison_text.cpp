// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "study/study_comparison_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "palmar/core/version.h"
#include "palmar/report/words/study_words.h"

namespace palmar::cli {
namespace {

using Json = nlohmann::ordered_json;

Json interval_object(const statistics::Interval& interval) { return {interval.low, interval.high}; }

Json pair_object(const study::StudyPlan& plan, const study::ProductPair& pair) {
  const auto name = [&](int product) {
    return plan.products[static_cast<std::size_t>(product)].name;
  };
  Json left_out = Json::array();
  for (const study::LeftOutHands& one : pair.left_out) {
    left_out.push_back(
        {{"product", name(one.product)}, {"cause", one.cause}, {"hands", one.hands}});
  }
  Json object = {{"first", name(pair.first)}, {"second", name(pair.second)},
                 {"hands", pair.hands},       {"pairs", pair.pairs},
                 {"left_out", left_out},      {"verdict", name_of(pair.verdict)}};
  if (pair.verdict == study::DifferenceVerdict::kTooFewPairs) return object;
  const statistics::PairedTest& t = pair.t_test;
  object["lower_in_second"] = pair.lower_in_second;
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

Json product_object(const study::StudyProduct& product, const study::StudyQuantity& quantity,
                    const study::ProductStatistics& statistics) {
  Json outcomes = Json::object();
  for (int k = 0; k < study::kStudyOutcomes; ++k) {
    const int hands = statistics.outcomes.of[static_cast<std::size_t>(k)];
    if (hands > 0) outcomes[name_of(static_cast<study::StudyOutcome>(k))] = hands;
  }
  if (statistics.outcomes.not_run > 0) outcomes["not_run"] = statistics.outcomes.not_run;
  Json object = {{"product", product.name}, {"outcomes", outcomes}};
  if (const study::QuantitySummary* one = study::summary_of(statistics, quantity.key)) {
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

Json comparison_object(const workflow::StudyCompareOutcome& outcome,
                       const study::ComparisonOptions& options) {
  const study::StudyPlan& plan = outcome.results.plan;
  Json conditions = Json::array();
  for (const workflow::ComparedCondition& condition : outcome.conditions) {
    Json compared = Json::array();
    for (const workflow::ComparedQuantity& one : condition.quantities) {
      Json products = Json::array();
      for (std::size_t p = 0; p < one.products.size(); ++p) {
        products.push_back(product_object(plan.products[p], one.quantity, one.products[p]));
      }
      Json pairs = Json::array();
      for (const workflow::ComparedPair& compared_pair : one.pairs) {
        pairs.push_back(pair_object(plan, compared_pair.pair));
        if (const auto& forces = compared_pair.forces) {
          pairs.back()["mean_grip_forces_n"] = {forces->first, forces->second};
        }
      }
      compared.push_back({{"quantity", one.quantity.key},
                          {"name", one.quantity.name},
                          {"unit", one.quantity.unit},
                          {"products", products},
                          {"pairs", pairs}});
    }
    conditions.push_back(
        {{"condition", title_of(plan, condition.condition)}, {"quantities", compared}});
  }
  const report::StudyAnswer& answer = outcome.answer;
  const auto name_or_null = [&](const std::optional<int>& product) {
    return product ? Json(plan.products[static_cast<std::size_t>(*product)].name) : Json(nullptr);
  };
  Json verdict = {{"sentence", answer.sentence},
                  {"reasons", answer.reasons},
                  {"next", answer.next},
                  {"command", answer.command},
                  {"better", name_or_null(answer.better)},
                  {"worse", name_or_null(answer.worse)}};
  return {{"study", plan.name},
          {"verdict", std::move(verdict)},
          {"significance", options.significance},
          {"conditions", conditions},
          {"palmar", version()}};
}

std::string answer_text(const report::StudyAnswer& answer) {
  std::string text = answer.sentence + "\n";
  for (const std::string& reason : answer.reasons) text += "  " + reason + "\n";
  if (!answer.command.empty()) text += answer.next + "\n  " + answer.command + "\n";
  return text;
}

std::string comparison_text(const workflow::StudyCompareOutcome& outcome) {
  const study::StudyPlan& plan = outcome.results.plan;
  std::size_t width = 7;
  for (const study::StudyProduct& one : plan.products) width = std::max(width, one.name.size());
  std::string text = answer_text(outcome.answer) + "\n";
  for (const auto& [condition, quantities] : outcome.conditions) {
    text += title_of(plan, condition) + "\n";
    for (const auto& [quantity, products, pairs] : quantities) {
      text +=
          fmt::format("  {}{}\n", quantity.name, quantity.unit.empty() ? "" : ", " + quantity.unit);
      text += fmt::format("    {:<{}}  {:>5} {:>10} {:>10} {:>10} {:>10} {:>10}\n", "product",
                          width, "hands", "mean", "SD", "P5", "median", "P95");
      for (std::size_t p = 0; p < products.size(); ++p) {
        const std::string& name = plan.products[p].name;
        const study::QuantitySummary* one = study::summary_of(products[p], quantity.key);
        if (one == nullptr) {
          text += fmt::format("    {:<{}}  {:>5}\n", name, width, 0);
          continue;
        }
        text += fmt::format("    {:<{}}  {:>5} {:>10.4g} {:>10.3g} {:>10.4g} {:>10.4g} {:>10.4g}\n",
                            name, width, one->summary.n, one->summary.mean, one->summary.sd,
                            one->p5, one->summary.median, one->p95);
      }
      for (const auto& [pair, forces] : pairs) {
        text += "    " + report::pair_words(plan, quantity, pair) + "\n";
        const std::string force =
            report::grip_force_words(outcome.results, condition, pair.first, pair.second);
        if (!force.empty()) text += "      " + force + "\n";
        const std::string left_out = report::left_out_words(plan, pair);
        if (!left_out.empty()) text += "      left out: " + left_out + "\n";
      }
    }
  }
  return text;
}

}  // namespace palmar::cli
