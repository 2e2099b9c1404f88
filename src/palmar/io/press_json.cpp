// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/io/press_json.h"

#include <nlohmann/json.hpp>

#include "palmar/core/version.h"

namespace palmar {

std::string press_json(const std::vector<PressStep>& steps) {
  using Json = nlohmann::ordered_json;
  Json list = Json::array();
  for (const PressStep& step : steps) {
    list.push_back({{"depth_mm", step.depth},
                    {"force_n", step.force},
                    {"contact_area_mm2", step.area},
                    {"peak_pressure_mpa", step.peak_pressure},
                    {"peak_pressure_cells_mpa", step.peak_pressure_cells},
                    {"mean_pressure_mpa", step.mean_pressure},
                    {"shear_modulus_mpa", step.shear_modulus},
                    {"complementarity_error_n_mm", step.complementarity_error},
                    {"relative_residual", step.relative_residual}});
  }
  const Json json = {{"steps", std::move(list)},
                     {"versions", {{"palmar", version()}, {"build", build_description()}}}};
  return json.dump(2);
}

}  // namespace palmar
