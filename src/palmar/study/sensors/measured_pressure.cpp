// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/sensors/measured_pressure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "palmar/core/error.h"
#include "palmar/core/nearest_name.h"

namespace palmar::study {
namespace {

using Key = std::tuple<std::string, int, int>;

[[noreturn]] void refuse(const SensorReading& reading, const MeasuredPressure& measured,
                         const MeasuredCell& cell) {
  const std::string where = fmt::format("{}:{}: ", measured.source, cell.line);
  std::vector<std::string> patches;
  int rows = 0, columns = 0;
  for (const SensorCell& one : reading.cells) {
    if (patches.empty() || patches.back() != one.patch) patches.push_back(one.patch);
    if (one.patch != cell.patch) continue;
    rows = std::max(rows, one.row);
    columns = std::max(columns, one.column);
  }
  if (rows == 0) {
    throw InputError(fmt::format(
        "{}patch \"{}\" is not in layout \"{}\"; {}", where, cell.patch, reading.layout.name,
        did_you_mean(cell.patch, patches, "it has " + patches.front() + " to " + patches.back())));
  }
  throw InputError(fmt::format(
      "{}row {}, column {} of {} is not in layout \"{}\"; rows 1 to {} and columns 1 to {} are",
      where, cell.row, cell.column, cell.patch, reading.layout.name, rows, columns));
}

std::vector<double> force_by_cell(const SensorReading& reading, const MeasuredPressure& measured) {
  std::map<Key, std::size_t> place;
  for (std::size_t i = 0; i < reading.cells.size(); ++i) {
    const SensorCell& one = reading.cells[i];
    place[{one.patch, one.row, one.column}] = i;
  }
  std::vector<double> force(reading.cells.size(), 0.0);
  std::vector<int> count(force.size(), 0);
  for (const MeasuredCell& cell : measured.cells) {
    const auto found = place.find({cell.patch, cell.row, cell.column});
    if (found == place.end()) refuse(reading, measured, cell);
    force[found->second] +=
        cell.is_pressure ? cell.load * reading.cells[found->second].area : cell.load;
    ++count[found->second];
  }
  for (std::size_t i = 0; i < force.size(); ++i) force[i] /= std::max(count[i], 1);
  return force;
}

std::string part_of(const SensorReading& reading, const SensorCell& cell) {
  if (reading.layout.kind != SensorKind::kMat) return cell.patch;
  return cell.region ? std::string(name_of(*cell.region)) : "beside the hand";
}

}  // namespace

PressureComparison compare_pressure(const SensorReading& reading,
                                    const MeasuredPressure& measured) {
  PressureComparison result;
  result.source = measured.source;
  result.measured = force_by_cell(reading, measured);
  std::vector<double> theirs, ours;
  double squares = 0.0;
  for (std::size_t i = 0; i < reading.cells.size(); ++i) {
    const SensorCell& cell = reading.cells[i];
    if (!(cell.area > 0.0)) continue;
    const double force = result.measured[i];
    result.force_measured += force;
    result.force_simulated += cell.force;
    result.peak_measured = std::max(result.peak_measured, force / cell.area);
    result.peak_simulated = std::max(result.peak_simulated, cell.mean_pressure);
    const std::string name = part_of(reading, cell);
    auto part = std::find_if(result.parts.begin(), result.parts.end(),
                             [&](const SensorPart& one) { return one.name == name; });
    if (part == result.parts.end()) part = result.parts.insert(part, SensorPart{.name = name});
    ++part->cells;
    part->measured += force;
    part->simulated += cell.force;
    if (!(force > 0.0 || cell.force > 0.0)) continue;
    theirs.push_back(force / cell.area);
    ours.push_back(cell.mean_pressure);
    const double difference = ours.back() - theirs.back();
    squares += difference * difference;
    result.mean_difference += difference;
  }
  result.compared = static_cast<int>(ours.size());
  if (result.compared < 3) {
    throw InputError(
        fmt::format("{}: {} cell{} loaded, measured or simulated; a comparison needs 3 or more",
                    measured.source, result.compared, result.compared == 1 ? " is" : "s are"));
  }
  result.rms = std::sqrt(squares / result.compared);
  result.mean_difference /= result.compared;
  result.pearson = statistics::pearson(theirs, ours);
  result.spearman = statistics::spearman(theirs, ours);
  std::stable_sort(result.parts.begin(), result.parts.end(),
                   [](const SensorPart& a, const SensorPart& b) {
                     return std::max(a.measured, a.simulated) > std::max(b.measured, b.simulated);
                   });
  std::erase_if(result.parts,
                [](const SensorPart& one) { return one.measured == 0.0 && one.simulated == 0.0; });
  return result;
}

}  // namespace palmar::study
