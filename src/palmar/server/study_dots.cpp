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

namespace palmar {

std::string study_dots_json(const std::filesystem::path& path) {
  using DotsJson = nlohmann::ordered_json;
  const StudyStore store(path);
  StudyResults results{store.plan(), {}};
  store.for_each(false, [&](const StudyRecord& record) { results.records.push_back(record); });
  const StudyPlan& plan = results.plan;
  const StudyCondition condition = conditions_of(plan).front();
  const std::vector<int> hands = hands_of(plan, condition);
  const std::vector<int> shown = shown_hands(plan, condition, StudyReportOptions{}.most_grasps);

  DotsJson json;
  for (std::size_t p = 0; p < plan.products.size(); ++p) {
    const Rgb colour = product_colour(static_cast<int>(p));
    json["products"].push_back(
        {{"name", plan.products[p].name}, {"colour", {colour.r, colour.g, colour.b}}});
  }
  json["hands"] = json["quantities"] = json["grasps"] = DotsJson::array();
  std::vector<StudyQuantity> quantities;
  const std::vector<StudyQuantity> known = quantities_of(results);
  for (const std::string& key : main_quantities()) {
    const auto found = std::find_if(known.begin(), known.end(),
                                    [&](const StudyQuantity& one) { return one.key == key; });
    if (found == known.end()) continue;
    quantities.push_back(*found);
    json["quantities"].push_back(
        {{"key", found->key}, {"name", found->name}, {"unit", found->unit}});
  }
  for (std::size_t h = 0; h < hands.size(); ++h) {
    const auto in_view = std::find(shown.begin(), shown.end(), hands[h]);
    json["hands"].push_back(
        {{"length_mm", finite_or_null(size_of(plan, condition, hands[h], kHandLength))},
         {"shown", in_view == shown.end() ? DotsJson(nullptr)
                                          : DotsJson(std::distance(shown.begin(), in_view))}});
    for (int p = 0; p < static_cast<int>(plan.products.size()); ++p) {
      const StudyRecord* const record = record_of(results, condition, p, hands[h]);
      if (record == nullptr) continue;
      DotsJson values = DotsJson::array();
      for (const StudyQuantity& one : quantities) {
        values.push_back(is_in_hand(*record) ? finite_or_null(quantity_of(*record, one.key))
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

}  // namespace palmar
