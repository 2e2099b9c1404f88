// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/sensors/sensor_json.h"

#include <string>
#include <utility>

#include "palmar/records/json_values.h"

namespace palmar::records {
namespace {

using SensorJson = nlohmann::ordered_json;

SensorJson correlation_object(const statistics::Correlation& one) {
  SensorJson json = {{"r", one.r}, {"n", one.n}, {"p_value", one.p_value}};
  if (one.interval) {
    json["low"] = one.interval->low;
    json["high"] = one.interval->high;
  }
  return json;
}

SensorJson pressure_comparison_object(const study::PressureComparison& one) {
  SensorJson parts = SensorJson::array();
  for (const study::SensorPart& part : one.parts) {
    parts.push_back({{"name", part.name},
                     {"cells", part.cells},
                     {"measured_n", part.measured},
                     {"simulated_n", part.simulated}});
  }
  return {{"source", one.source},
          {"force_measured_n", one.force_measured},
          {"force_simulated_n", one.force_simulated},
          {"peak_measured_mpa", one.peak_measured},
          {"peak_simulated_mpa", one.peak_simulated},
          {"compared", one.compared},
          {"pearson", correlation_object(one.pearson)},
          {"spearman", correlation_object(one.spearman)},
          {"rms_mpa", one.rms},
          {"mean_difference_mpa", one.mean_difference},
          {"parts", std::move(parts)},
          {"cell_force_n", one.measured}};
}

}  // namespace

nlohmann::ordered_json sensor_object(const study::Assessment& assessment) {
  const study::SensorReading& reading = *assessment.sensors;
  const study::SensorLayout& layout = reading.layout;
  SensorJson cells = SensorJson::array();
  for (const study::SensorCell& cell : reading.cells) {
    cells.push_back({{"patch", cell.patch},
                     {"row", cell.row},
                     {"column", cell.column},
                     {"area_mm2", cell.area},
                     {"force_n", cell.force},
                     {"mean_pressure_mpa", cell.mean_pressure},
                     {"region", cell.region ? SensorJson(name_of(*cell.region)) : SensorJson()}});
  }
  return {{"layout",
           {{"name", layout.name},
            {"kind", name_of(layout.kind)},
            {"pitch_mm", layout.pitch},
            {"source", layout.source}}},
          {"rows", reading.rows},
          {"columns", reading.columns},
          {"force_n", reading.force},
          {"force_beside_n", reading.force_beside},
          {"peak_pressure_mpa", reading.peak_pressure},
          {"pressed_area_mm2", reading.area},
          {"cells", std::move(cells)},
          {"measured",
           assessment.measured ? pressure_comparison_object(*assessment.measured) : SensorJson()}};
}

}  // namespace palmar::records
