// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/press_json.h"

#include <nlohmann/json.hpp>
#include <numbers>

#include "palmar/core/version.h"
#include "palmar/formats/text_scan.h"
#include "palmar/records/json_values.h"

namespace palmar::records {
namespace {

using Json = nlohmann::ordered_json;

struct Column {
  const char* name;
  double contact::PressStep::*value;
};

constexpr Column kStepColumns[] = {
    {"depth_mm", &contact::PressStep::depth},
    {"force_n", &contact::PressStep::force},
    {"contact_area_mm2", &contact::PressStep::area},
    {"peak_pressure_mpa", &contact::PressStep::peak_pressure},
    {"peak_pressure_cells_mpa", &contact::PressStep::peak_pressure_cells},
    {"mean_pressure_mpa", &contact::PressStep::mean_pressure},
    {"shear_modulus_mpa", &contact::PressStep::shear_modulus},
    {"complementarity_error_n_mm", &contact::PressStep::complementarity_error},
    {"relative_residual", &contact::PressStep::relative_residual},
    {"spacing_mm", &contact::PressStep::spacing}};

Json coating_object(const std::optional<contact::Coating>& coating) {
  if (!coating) return nullptr;
  return {{"thickness_mm", coating->thickness},
          {"shear_modulus_mpa", coating->shear_modulus},
          {"poisson", coating->poisson}};
}

}  // namespace

std::string press_json(const contact::PressOptions& options, const PressSetting& setting,
                       const std::vector<contact::PressStep>& steps) {
  Json list = Json::array();
  for (const contact::PressStep& step : steps) {
    Json object = Json::object();
    for (const Column& column : kStepColumns) object[column.name] = step.*column.value;
    object["vertices"] = step.vertices;
    list.push_back(std::move(object));
  }
  const Json test = {{"specimen", name_of(options.specimen)},
                     {"hand", setting.hand.empty() ? Json(nullptr) : Json(setting.hand)},
                     {"indenter", name_of(options.indenter)},
                     {"tilt_deg", options.tilt * 180.0 / std::numbers::pi},
                     {"equations", name_of(setting.model)},
                     {"kernel", name_of(setting.model.kernel)},
                     {"tissue_model", name_of(setting.model.tissue)},
                     {"tissue_level", contact::name_of(options.tissue_level)},
                     {"layer_mm", or_null(options.layer_thickness)},
                     {"poisson", or_null(options.poisson)},
                     {"coating", coating_object(options.coating)}};
  const Json json = {{"test", test},
                     {"steps", std::move(list)},
                     {"versions", {{"palmar", version()}, {"build", build_description()}}}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

CsvTable press_table(const std::vector<contact::PressStep>& steps) {
  CsvTable table;
  for (const Column& column : kStepColumns) table.header.emplace_back(column.name);
  for (const contact::PressStep& step : steps) {
    std::vector<std::string>& row = table.rows.emplace_back();
    for (const Column& column : kStepColumns) row.push_back(formats::shortest(step.*column.value));
  }
  return table;
}

}  // namespace palmar::records
