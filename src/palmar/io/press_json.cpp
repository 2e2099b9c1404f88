// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/io/press_json.h"

#include <nlohmann/json.hpp>

namespace palmar {

std::string press_json(const std::vector<PressStep>& steps) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
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
  return nlohmann::ordered_json{{"steps", std::move(list)}}.dump(2);
}

}  // namespace palmar
