// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/server/study_dots.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "palmar/records/json_values.h"
#include "palmar/records/study/study_store.h"
#include "palmar/report/chart/study_charts.h"
#include "palmar/report/chart/study_figures.h"
#include "palmar/report/study/study_report.h"
#include "palmar/report/study/study_scene.h"
#include "palmar/study/statistics/study_results.h"
#include "palmar/study/statistics/study_statistics.h"

namespace palmar::server {

std::string study_dots_json(const std::filesystem::path& path) {
  using DotsJson = nlohmann::ordered_json;
  const records::StudyStore store(path);
  study::StudyResults results{store.plan(), {}};
  store.for_each(false,
                 [&](const study::StudyRecord& record) { results.records.push_back(record); });
  const study::StudyPlan& plan = results.plan;
  const study::StudyCondition condition = study::conditions_of(plan).front();
  const std::vector<int> hands = study::hands_of(plan, condition);
  const std::vector<int> shown =
      report::shown_hands(plan, condition, report::StudyReportOptions{}.most_grasps);

  DotsJson json;
  for (std::size_t p = 0; p < plan.products.size(); ++p) {
    const report::Rgb colour = report::product_colour(static_cast<int>(p));
    json["products"].push_back(
        {{"name", plan.products[p].name}, {"colour", {colour.r, colour.g, colour.b}}});
  }
  json["hands"] = json["quantities"] = json["grasps"] = DotsJson::array();
  std::vector<study::StudyQuantity> quantities;
  const std::vector<study::StudyQuantity> known = study::quantities_of(results);
  for (const std::string& key : report::main_quantities()) {
    const auto found =
        std::find_if(known.begin(), known.end(),
                     [&](const study::StudyQuantity& one) { return one.key == key; });
    if (found == known.end()) continue;
    quantities.push_back(*found);
    json["quantities"].push_back(
        {{"key", found->key}, {"name", found->name}, {"unit", found->unit}});
  }
  for (std::size_t h = 0; h < hands.size(); ++h) {
    const auto in_view = std::find(shown.begin(), shown.end(), hands[h]);
    json["hands"].push_back(
        {{"length_mm",
          records::finite_or_null(study::size_of(plan, condition, hands[h], study::kHandLength))},
         {"shown", in_view == shown.end() ? DotsJson(nullptr)
                                          : DotsJson(std::distance(shown.begin(), in_view))}});
    for (int p = 0; p < static_cast<int>(plan.products.size()); ++p) {
      const study::StudyRecord* const record = study::record_of(results, condition, p, hands[h]);
      if (record == nullptr) continue;
      DotsJson values = DotsJson::array();
      for (const study::StudyQuantity& one : quantities) {
        values.push_back(study::is_in_hand(*record)
                             ? records::finite_or_null(study::quantity_of(*record, one.key))
                             : DotsJson(nullptr));
      }
      json["grasps"].push_back({{"hand", h},
                                {"product", p},
                                {"outcome", name_of(record->outcome)},
                                {"values", std::move(values)}});
    }
  }
  return json.dump(-1, ' ', false, DotsJson::error_handler_t::replace);
}

}  // namespace palmar::server
