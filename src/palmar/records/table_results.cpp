// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/table_results.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "palmar/core/text.h"
#include "palmar/formats/text_scan.h"
#include "palmar/records/json_values.h"
#include "palmar/statistics/paired_test.h"

namespace palmar::records {
namespace {

using nlohmann::ordered_json;

/// "mean_mm"; without unit "mean".
std::string key(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : name + "_" + unit;
}

template <typename Result, typename Fill>
std::string results_json(const TableResults<Result>& results, const Fill& fill) {
  ordered_json json;
  json["table"] = results.source;
  json["by"] = results.by;
  json["level"] = results.level;
  json["notes"] = results.notes;
  json["groups"] = ordered_json::array();
  for (const auto& group : results.groups) {
    ordered_json one;
    one["group"] = group.name;
    one["subjects"] = group.subjects;
    fill(one, group.result);
    json["groups"].push_back(std::move(one));
  }
  return json_file_text(json);
}

ordered_json interval(const std::optional<statistics::Interval>& ends) {
  return ends ? ordered_json{ends->low, ends->high} : ordered_json(nullptr);
}

ordered_json description(const population::ColumnDescription& d) {
  ordered_json one;
  one["name"] = d.name;
  one["unit"] = d.unit;
  one["n"] = d.summary ? d.summary->n : 0;
  one["missing"] = d.missing;
  if (!d.summary) return one;
  const statistics::Summary& s = *d.summary;
  one[key("mean", d.unit)] = s.mean;
  one[key("mean_interval", d.unit)] = interval(s.mean_interval);
  // One person has no deviation.
  one[key("sd", d.unit)] = s.n > 1 ? ordered_json(s.sd) : ordered_json(nullptr);
  one[key("standard_error", d.unit)] =
      s.n > 1 ? ordered_json(s.standard_error) : ordered_json(nullptr);
  one[key("min", d.unit)] = s.min;
  ordered_json& percentiles = one[key("percentiles", d.unit)];
  for (std::size_t i = 0; i < population::kTablePercentiles.size(); ++i) {
    percentiles["p" + formats::shortest(population::kTablePercentiles[i])] = d.percentiles[i];
  }
  one[key("max", d.unit)] = s.max;
  one["skewness"] = or_null(s.skewness);
  one["excess_kurtosis"] = or_null(s.excess_kurtosis);
  return one;
}

ordered_json coefficient(const statistics::Coefficient& c) {
  return {{"estimate", c.estimate},
          {"standard_error", c.standard_error},
          {"t", c.t},
          {"p_value", c.p_value}};
}

std::string name_of_status(statistics::FitStatus status) {
  switch (status) {
    case statistics::FitStatus::kFitted:
      return "fitted";
    case statistics::FitStatus::kExact:
      return "exact";
    case statistics::FitStatus::kConstantY:
      break;
  }
  return "constant";
}

ordered_json regression(const population::TableRegression& r, bool is_best) {
  ordered_json one;
  one["dimension"] = r.name;
  one["unit"] = r.unit;
  one["predictors"] = r.predictors;
  one["n"] = r.fit.n;
  one["status"] = name_of_status(r.fit.status);
  one["intercept"] = coefficient(r.fit.intercept);
  one["slopes"] = ordered_json::array();
  for (const statistics::Coefficient& slope : r.fit.slopes)
    one["slopes"].push_back(coefficient(slope));
  one["r2"] = r.fit.r2;
  one["adjusted_r2"] = r.fit.adjusted_r2;
  one[key("residual_sd", r.unit)] = r.fit.residual_sd;
  one["f"] = r.fit.f;
  one["p_value"] = r.fit.f_p_value;
  one["is_best_single"] = is_best;
  return one;
}

bool is_best(const std::vector<population::TableRegression>& all, std::size_t place) {
  return population::best_predictor(all, all[place].name) == static_cast<int>(place);
}

std::string end_of(const std::optional<statistics::Interval>& ends, bool is_low) {
  return ends ? formats::shortest(is_low ? ends->low : ends->high) : "";
}

}  // namespace

std::vector<double> adjusted_p_values(const population::TableCorrelation& correlation) {
  std::vector<double> p;
  for (const auto& pair : correlation.pairs) p.push_back(pair.pearson.p_value);
  return statistics::holm(p);
}

std::string descriptions_json(const Descriptions& descriptions) {
  return results_json(descriptions, [](ordered_json& group, const auto& columns) {
    group["dimensions"] = ordered_json::array();
    for (const population::ColumnDescription& d : columns)
      group["dimensions"].push_back(description(d));
  });
}

std::string correlations_json(const Correlations& correlations) {
  return results_json(correlations, [](ordered_json& group, const population::TableCorrelation& c) {
    const std::vector<double> adjusted = adjusted_p_values(c);
    group["pairs"] = ordered_json::array();
    for (std::size_t i = 0; i < c.pairs.size(); ++i) {
      const auto& pair = c.pairs[i];
      group["pairs"].push_back({{"a", c.names[pair.a]},
                                {"b", c.names[pair.b]},
                                {"n", pair.pearson.n},
                                {"r", pair.pearson.r},
                                {"interval", interval(pair.pearson.interval)},
                                {"p_value", pair.pearson.p_value},
                                {"p_holm", adjusted[i]},
                                {"spearman_rho", pair.spearman.r},
                                {"spearman_p_value", pair.spearman.p_value}});
    }
    group["notes"] = c.notes;
  });
}

std::string regressions_json(const Regressions& regressions) {
  return results_json(regressions, [](ordered_json& group, const auto& all) {
    group["regressions"] = ordered_json::array();
    for (std::size_t i = 0; i < all.size(); ++i) {
      group["regressions"].push_back(regression(all[i], is_best(all, i)));
    }
  });
}

CsvTable descriptions_csv(const Descriptions& descriptions) {
  CsvTable table;
  table.header = {"group",     "dimension", "unit",           "n",  "missing", "mean", "mean_low",
                  "mean_high", "sd",        "standard_error", "min"};
  for (const double p : population::kTablePercentiles)
    table.header.push_back("p" + formats::shortest(p));
  for (const char* name : {"max", "skewness", "excess_kurtosis"}) table.header.emplace_back(name);
  for (const auto& group : descriptions.groups) {
    for (const population::ColumnDescription& d : group.result) {
      std::vector<std::string> row = {group.name, d.name, d.unit,
                                      std::to_string(d.summary ? d.summary->n : 0),
                                      std::to_string(d.missing)};
      if (d.summary) {
        const statistics::Summary& s = *d.summary;
        row.insert(row.end(),
                   {formats::shortest(s.mean), end_of(s.mean_interval, true),
                    end_of(s.mean_interval, false), s.n > 1 ? formats::shortest(s.sd) : "",
                    s.n > 1 ? formats::shortest(s.standard_error) : "", formats::shortest(s.min)});
        for (const double p : d.percentiles) row.push_back(formats::shortest(p));
        row.push_back(formats::shortest(s.max));
        row.push_back(s.skewness ? formats::shortest(*s.skewness) : "");
        row.push_back(s.excess_kurtosis ? formats::shortest(*s.excess_kurtosis) : "");
      }
      row.resize(table.header.size());
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

CsvTable correlations_csv(const Correlations& correlations) {
  CsvTable table;
  table.header = {"group",           "a",      "b",       "n",      "r",
                  "r_low",           "r_high", "p_value", "p_holm", "spearman_rho",
                  "spearman_p_value"};
  for (const auto& group : correlations.groups) {
    const population::TableCorrelation& c = group.result;
    const std::vector<double> adjusted = adjusted_p_values(c);
    for (std::size_t i = 0; i < c.pairs.size(); ++i) {
      const auto& pair = c.pairs[i];
      table.rows.push_back(
          {group.name, c.names[pair.a], c.names[pair.b], std::to_string(pair.pearson.n),
           formats::shortest(pair.pearson.r), end_of(pair.pearson.interval, true),
           end_of(pair.pearson.interval, false), formats::shortest(pair.pearson.p_value),
           formats::shortest(adjusted[i]), formats::shortest(pair.spearman.r),
           formats::shortest(pair.spearman.p_value)});
    }
  }
  return table;
}

CsvTable regressions_csv(const Regressions& regressions) {
  CsvTable table;
  table.header = {"group",       "dimension", "unit",      "predictors",
                  "n",           "predictor", "estimate",  "standard_error",
                  "t",           "p_value",   "r2",        "adjusted_r2",
                  "residual_sd", "f",         "f_p_value", "is_best_single"};
  for (const auto& group : regressions.groups) {
    for (std::size_t i = 0; i < group.result.size(); ++i) {
      const population::TableRegression& r = group.result[i];
      // One row per number: the intercept, then the slopes.
      for (std::size_t k = 0; k <= r.predictors.size(); ++k) {
        const statistics::Coefficient& c = k == 0 ? r.fit.intercept : r.fit.slopes[k - 1];
        table.rows.push_back({group.name, r.name, r.unit, joined(r.predictors, "+"),
                              std::to_string(r.fit.n), k == 0 ? "intercept" : r.predictors[k - 1],
                              formats::shortest(c.estimate), formats::shortest(c.standard_error),
                              formats::shortest(c.t), formats::shortest(c.p_value),
                              formats::shortest(r.fit.r2), formats::shortest(r.fit.adjusted_r2),
                              formats::shortest(r.fit.residual_sd), formats::shortest(r.fit.f),
                              formats::shortest(r.fit.f_p_value),
                              is_best(group.result, i) ? "yes" : "no"});
      }
    }
  }
  return table;
}

std::string p_text(double p_value) {
  if (p_value < 1e-300) return "< 1e-300";
  if (p_value < 1e-3) return fmt::format("{:.1e}", p_value);
  return fmt::format("{:.3f}", p_value);
}

}  // namespace palmar::records
