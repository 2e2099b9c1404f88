// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "study_report_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "palmar/core/error.h"
#include "palmar/core/version.h"
#include "palmar/io/study_store.h"
#include "palmar/report/study_report.h"
#include "palmar/report/study_words.h"
#include "palmar/study/study_analysis.h"

namespace palmar::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kDefaultQuantity = "peak_pressure_cells_mpa";

StudyResults results_of(const StudyStore& store) {
  StudyResults results{store.plan(), {}};
  store.for_each(false, [&](const StudyRecord& record) { results.records.push_back(record); });
  if (results.records.empty()) {
    throw UsageError(store.path().string() +
                     ": no grasp was run yet; palmar study run or resume does");
  }
  return results;
}

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

/// Everything that is compared: per condition, per quantity.
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

void add_report(CLI::App& noun, Context& context) {
  struct Options {
    std::string store, out;
    double threshold = 1000.0 * kBloodFlowStop;  // kPa
    StudyReportOptions report;
    bool no_pictures = false, no_figures = false;
  };
  const auto o = std::make_shared<Options>();
  CLI::App* verb =
      add_verb(noun, "report", "One page with all figures, comparisons, 3-D views and provenance",
               "palmar study report handles.palmar --out report");
  verb->add_option("STORE", o->store, "Study: a *.palmar file")->required();
  verb->add_option("--out", o->out, "Folder for report.html, tables and figures")->required();
  verb->add_option("--threshold-kpa", o->threshold,
                   "Maps of the share of hands above this pressure (blood-flow family)")
      ->capture_default_str();
  verb->add_option("--significance", o->report.comparison.significance,
                   "Corrected p values below it name a difference")
      ->capture_default_str();
  verb->add_option("--most-grasps", o->report.most_grasps,
                   "Grasps in the 3-D view, evenly chosen by hand length; 0: no view")
      ->capture_default_str();
  verb->add_flag("--no-pictures", o->no_pictures, "No pictures of the maps");
  verb->add_flag("--no-figures", o->no_figures, "No figures as SVG, PNG and PDF beside the page");
  verb->callback([&context, o] {
    context.run = [&context, o] {
      if (!(o->threshold >= 0.0 && o->threshold <= 1e5)) {
        throw UsageError(
            fmt::format("--threshold-kpa is {:g} kPa; 0 to 100000 kPa are allowed", o->threshold));
      }
      StudyReportOptions options = o->report;
      options.threshold = o->threshold / 1000.0;
      options.pictures = !o->no_pictures;
      options.figure_files = !o->no_figures;
      options.check();
      const StudyStore store(o->store);
      const StudyResults results = results_of(store);
      const StudyInputs inputs = store.inputs();
      const StudyReportInput input{results, inputs,
                                   [&store](const std::function<void(const StudyRecord&)>& visit) {
                                     store.for_each(true, visit);
                                   },
                                   store.program(), store.digest()};
      const Progress progress = make_progress(context.common);
      write_study_report(o->out, input, options, progress);
      finish_progress();
      const std::string page = (std::filesystem::path(o->out) / "report.html").string();
      print(context.common.json ? Json({{"report", page}}).dump() + "\n" : page + "\n");
      return 0;
    };
  });
}

void add_compare(CLI::App& noun, Context& context) {
  struct Options {
    std::string store;
    std::vector<std::string> quantities;
    ComparisonOptions comparison;
  };
  const auto o = std::make_shared<Options>();
  CLI::App* verb =
      add_verb(noun, "compare", "Differences between products over the same hands",
               "palmar study compare handles.palmar --quantity peak_pressure_cells_mpa");
  verb->add_option("STORE", o->store, "Study: a *.palmar file")->required();
  verb->add_option("--quantity", o->quantities,
                   "What is compared, one or several: peak_pressure_cells_mpa, contact_area_mm2, "
                   "force_n, an index; all for everything")
      ->delimiter(',');
  verb->add_option("--significance", o->comparison.significance,
                   "Corrected p values below it name a difference")
      ->capture_default_str();
  verb->callback([&context, o] {
    context.run = [&context, o] {
      o->comparison.check();
      const StudyStore store(o->store);
      const StudyResults results = results_of(store);
      std::vector<StudyQuantity> quantities;
      for (const std::string& key : o->quantities) {
        if (key == "all") {
          quantities = quantities_of(results);
          break;
        }
        quantities.push_back(quantity_named(results, key));
      }
      if (o->quantities.empty()) quantities = {quantity_named(results, kDefaultQuantity)};
      print(context.common.json
                ? comparison_object(results, quantities, o->comparison).dump(2) + "\n"
                : comparison_text(results, quantities, o->comparison));
      return 0;
    };
  });
}

}  // namespace

void add_study_report_commands(CLI::App& noun, Context& context) {
  add_report(noun, context);
  add_compare(noun, context);
}

}  // namespace palmar::cli
