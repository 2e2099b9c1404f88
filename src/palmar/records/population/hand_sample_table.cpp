// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/population/hand_sample_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "palmar/population/sex_names.h"
#include "palmar/records/json_values.h"

namespace palmar::records {
namespace {

using Json = nlohmann::ordered_json;

std::string word_of(std::optional<grasp::Sex> sex) { return sex ? population::name_of(*sex) : ""; }

Json json_word(std::optional<grasp::Sex> sex) { return sex ? Json(word_of(sex)) : Json(nullptr); }

// Dimensions of all hands, in the order in which they come up.
std::vector<hand::HandDimension> dimensions_of(const std::vector<population::HandSample>& hands) {
  std::vector<hand::HandDimension> list;
  for (const population::HandSample& hand : hands) {
    for (const hand::SizedDimension& one : hand.dimensions) {
      if (std::find(list.begin(), list.end(), one.dimension) == list.end()) {
        list.push_back(one.dimension);
      }
    }
  }
  return list;
}

Json dimension_json(hand::HandDimension dimension, double mean, double sd,
                    population::Evidence evidence, const std::string& source) {
  return {{"dimension", name_of(dimension)},
          {"mean_mm", mean},
          {"sd_mm", sd > 0.0 ? Json(sd) : Json(nullptr)},
          {"evidence", name_of(evidence)},
          {"source", source}};
}

Json stratum_json(const population::Stratum& stratum) {
  Json dimensions = Json::array();
  for (const population::DrivingDimension& one : stratum.driving) {
    dimensions.push_back(dimension_json(one.dimension, one.mean, one.sd, one.evidence, one.source));
  }
  for (const population::DimensionRegression& one : stratum.regressions) {
    const population::DimensionMoments moments =
        population::moments_of(stratum, one.dimension).value();
    dimensions.push_back(
        dimension_json(one.dimension, moments.mean, moments.sd, one.evidence, one.source));
  }
  Json correlations = Json::array();
  for (std::size_t i = 0; i < stratum.driving.size(); ++i) {
    for (std::size_t j = i + 1; j < stratum.driving.size(); ++j) {
      const auto a = static_cast<Eigen::Index>(i), b = static_cast<Eigen::Index>(j);
      correlations.push_back({{"between", Json::array({name_of(stratum.driving[i].dimension),
                                                       name_of(stratum.driving[j].dimension)})},
                              {"r", stratum.correlation(a, b)}});
    }
  }
  return {{"name", stratum.name},     {"sex", json_word(stratum.sex)},
          {"share", stratum.share},   {"age_years", or_null(stratum.age)},
          {"dimensions", dimensions}, {"correlations", correlations}};
}

}  // namespace

CsvTable hand_sample_table(const std::vector<population::HandSample>& hands) {
  const std::vector<hand::HandDimension> dimensions = dimensions_of(hands);
  CsvTable table;
  table.header = {"subject", "stratum", "sex", "age_years", "grip_strength_n"};
  for (const hand::HandDimension one : dimensions) table.header.push_back(name_of(one) + "_mm");
  for (const population::HandSample& hand : hands) {
    std::vector<std::string> row = {
        hand.label, hand.stratum, word_of(hand.sex), hand.age ? fmt::format("{}", *hand.age) : "",
        hand.grip_strength > 0.0 ? fmt::format("{:.1f}", hand.grip_strength) : ""};
    for (const hand::HandDimension one : dimensions) {
      const auto found = std::find_if(hand.dimensions.begin(), hand.dimensions.end(),
                                      [&](const auto& d) { return d.dimension == one; });
      row.push_back(found == hand.dimensions.end() ? "" : fmt::format("{:.3f}", found->value));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string hand_sample_json(const population::Population& population,
                             const population::SamplingOptions& options,
                             const std::vector<population::HandSample>& hands) {
  Json list = Json::array();
  for (const population::HandSample& hand : hands) {
    Json dimensions = Json::object();
    for (const hand::SizedDimension& one : hand.dimensions) {
      dimensions[name_of(one.dimension) + "_mm"] = one.value;
    }
    list.push_back(
        {{"subject", hand.label},
         {"stratum", hand.stratum},
         {"sex", json_word(hand.sex)},
         {"age_years", or_null(hand.age)},
         {"grip_strength_n", hand.grip_strength > 0.0 ? Json(hand.grip_strength) : Json(nullptr)},
         {"dimensions", dimensions}});
  }
  const Json json = {{"population", population.name},
                     {"source", population.source},
                     {"cautions", population.cautions},
                     {"design", name_of(options.design)},
                     {"seed", options.seed},
                     {"hands", list}};
  return json.dump(2) + "\n";
}

std::string population_json(const population::Population& population) {
  Json strata = Json::array();
  for (const population::Stratum& stratum : population.strata)
    strata.push_back(stratum_json(stratum));
  const Json json = {{"name", population.name},
                     {"title", population.title},
                     {"source", population.source},
                     {"cautions", population.cautions},
                     {"strata", strata}};
  return json.dump(2) + "\n";
}

}  // namespace palmar::records
