// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/validation_json.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "palmar/core/version.h"
#include "palmar/records/json_values.h"

namespace palmar::records {
namespace {

using Json = nlohmann::ordered_json;

/// JSON knows no NaN.
Json row_object(const validation::ValidationRow& row) {
  return {{"quantity", row.quantity},
          {"unit", row.unit},
          {"ours", finite_or_null(row.ours)},
          {"theirs", finite_or_null(row.target.value)},
          {"lowest_met", finite_or_null(row.target.lowest)},
          {"highest_met", finite_or_null(row.target.highest)},
          {"relative_difference", finite_or_null(row.difference)},
          {"verdict", name_of(row.verdict)},
          {"chosen_on_this_case", !row.chosen_in.empty()},
          {"chosen_in_commit", row.chosen_in.empty() ? Json() : Json(row.chosen_in)},
          {"row_from_commit", row.added_in.empty() ? Json() : Json(row.added_in)},
          {"source", row.target.source}};
}

}  // namespace

std::string validation_json(const validation::ValidationReport& report) {
  Json cases = Json::array();
  for (const validation::ValidationCase& one : report.cases) {
    Json rows = Json::array();
    for (const validation::ValidationRow& row : one.rows) rows.push_back(row_object(row));
    cases.push_back({{"case", one.id},
                     {"title", one.title},
                     {"rows", std::move(rows)},
                     {"seconds", one.seconds}});
  }
  const Json json = {{"hand", report.hand_name},
                     {"met", report.count(validation::Verdict::kMet)},
                     {"missed", report.count(validation::Verdict::kMissed)},
                     {"information", report.count(validation::Verdict::kInformation)},
                     {"not_built", report.count(validation::Verdict::kNotBuilt)},
                     {"cases", std::move(cases)},
                     {"versions", {{"palmar", version()}, {"build", build_description()}}}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace palmar::records
