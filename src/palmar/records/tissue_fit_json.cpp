// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/tissue_fit_json.h"

#include <nlohmann/json.hpp>

#include "palmar/core/version.h"
#include "palmar/records/json_values.h"

namespace palmar::records {
namespace {

using Json = nlohmann::ordered_json;

Json law(const hand::StiffeningLaw& one) {
  return {{"g0_kpa", 1000.0 * one.g0},
          {"g_limit_kpa", 1000.0 * one.g_limit},
          {"limit_depth_mm", one.limit_depth}};
}

}  // namespace

std::string_view name_of(geometry::LeastSquaresStatus status) {
  switch (status) {
    case geometry::LeastSquaresStatus::kConverged:
      return "converged";
    case geometry::LeastSquaresStatus::kSmallStep:
      return "small_step";
    case geometry::LeastSquaresStatus::kIterationLimit:
      return "iteration_limit";
    case geometry::LeastSquaresStatus::kBadStart:
      break;
  }
  return "bad_start";
}

std::string_view name_of(contact::ParameterStatus status) {
  if (status == contact::ParameterStatus::kFitted) return "fitted";
  return status == contact::ParameterStatus::kHeld ? "held" : "not_identifiable";
}

std::string tissue_fit_json(const contact::TissueFit& fit, const std::string& test,
                            double confidence) {
  Json json = {{"test", test},
               {"status", name_of(fit.status)},
               {"iterations", fit.iterations},
               {"confidence", confidence}};
  json["parameters"] = Json::array();
  for (const contact::FittedParameter& one : fit.parameters) {
    json["parameters"].push_back({{"name", one.name},
                                  {"unit", one.unit},
                                  {"value", one.value},
                                  {"lower", or_null(one.lower)},
                                  {"upper", or_null(one.upper)},
                                  {"status", name_of(one.status)},
                                  {"remark", one.remark}});
  }
  json["fitted"] = fit.fitted;
  json["correlation"] = Json::array();
  for (Eigen::Index i = 0; i < fit.correlation.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < fit.correlation.cols(); ++j) row.push_back(fit.correlation(i, j));
    json["correlation"].push_back(std::move(row));
  }
  json["eigenvalues"] = std::vector<double>(fit.eigenvalues.begin(), fit.eigenvalues.end());
  json["condition"] = fit.condition;
  json["degrees_of_freedom"] = fit.degrees_of_freedom;
  json["force_rms_n"] = fit.force_rms;
  json["force_rms_relative"] = fit.force_rms_relative;
  json["r_squared"] = fit.r_squared;
  json["area_measured_over_model"] = or_null(fit.area_ratio);
  json["area_rms_relative"] = or_null(fit.area_rms_relative);
  json["tissue"] = {{"nominal", law(fit.stiffness.nominal)},
                    {"low", law(fit.stiffness.low)},
                    {"high", law(fit.stiffness.high)}};
  json["layer_mm"] = or_null(fit.layer_thickness);
  json["subjects"] = Json::array();
  for (const contact::SubjectFit& one : fit.subjects) {
    Json entry = {{"subject", one.subject}, {"readings", one.points}};
    entry.update(law(one.law));
    entry["force_rms_n"] = one.force_rms;
    json["subjects"].push_back(std::move(entry));
  }
  json["points"] = Json::array();
  for (const contact::FittedPoint& point : fit.points) {
    Json entry = {
        {"line", point.measured.line},      {"subject", point.measured.subject},
        {"depth_mm", point.measured.depth}, {"force_n", point.measured.force},
        {"model_force_n", point.force},     {"residual_n", point.measured.force - point.force}};
    if (point.measured.area) entry["area_mm2"] = *point.measured.area;
    entry["model_area_mm2"] = point.area;
    json["points"].push_back(std::move(entry));
  }
  json["remarks"] = fit.remarks;
  json["versions"] = {{"palmar", version()}, {"build", build_description()}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace palmar::records
