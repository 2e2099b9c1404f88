// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/sensors/measured_pressure_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "palmar/formats/csv_reader.h"

namespace palmar::records {
namespace {

constexpr double kMpaPerKpa = 1e-3;
constexpr double kMostNumber = 100'000.0;  // of a row or column

struct ValueColumn {
  const char* name;
  double factor;
  bool is_pressure;
};
constexpr ValueColumn kValueColumns[] = {
    {"force_n", 1.0, false}, {"pressure_kpa", kMpaPerKpa, true}, {"pressure_mpa", 1.0, true}};

std::size_t need_column(const formats::CsvFile& file, const char* name, const std::string& why) {
  const int column = file.column(name);
  if (column < 0) {
    file.fail(file.header_line, fmt::format("column {} is missing; {}", name, why));
  }
  return static_cast<std::size_t>(column);
}

int whole_number(const formats::CsvFile& file, const formats::CsvFile::Row& row,
                 std::size_t column) {
  const double value = file.number(row, column);
  if (!(value >= 1.0 && value <= kMostNumber) || value != std::floor(value)) {
    file.fail(row.line, fmt::format("{} is {}; a whole number from 1 is needed",
                                    file.header[column], row.cells[column]));
  }
  return static_cast<int>(value);
}

}  // namespace

study::MeasuredPressure read_measured_pressure(const std::string& path,
                                               const study::SensorLayout& layout) {
  const formats::CsvFile file = formats::read_csv(path);
  const ValueColumn* kind = nullptr;
  std::size_t value_column = 0;
  for (const ValueColumn& one : kValueColumns) {
    const int column = file.column(one.name);
    if (column < 0) continue;
    if (kind != nullptr) {
      file.fail(file.header_line, fmt::format("columns {} and {} are both given; one is needed",
                                              kind->name, one.name));
    }
    kind = &one;
    value_column = static_cast<std::size_t>(column);
  }
  if (kind == nullptr) {
    file.fail(file.header_line,
              "no column has the load; force_n, pressure_kpa or pressure_mpa is needed");
  }
  const bool is_mat = layout.kind == study::SensorKind::kMat;
  const bool is_free = layout.kind == study::SensorKind::kFree;
  const std::string of_kind = fmt::format("a {} layout needs it", name_of(layout.kind));
  const std::size_t patch = is_mat ? 0 : need_column(file, "patch", of_kind);
  const std::size_t row_column = is_free ? 0 : need_column(file, "row", of_kind);
  const std::size_t column_column = is_free ? 0 : need_column(file, "column", of_kind);
  study::MeasuredPressure result;
  result.source = path;
  for (const formats::CsvFile::Row& row : file.rows) {
    study::MeasuredCell cell;
    cell.line = row.line;
    cell.patch = is_mat ? "mat" : row.cells[patch];
    if (!is_free) {
      cell.row = whole_number(file, row, row_column);
      cell.column = whole_number(file, row, column_column);
    }
    const double value = file.number(row, value_column);
    if (value < 0.0) {
      file.fail(row.line, fmt::format("{} is {}; 0 or more is needed", file.header[value_column],
                                      row.cells[value_column]));
    }
    cell.load = value * kind->factor;
    cell.is_pressure = kind->is_pressure;
    result.cells.push_back(std::move(cell));
  }
  if (result.cells.empty()) file.fail(file.header_line, "no row follows; a cell is needed");
  return result;
}

}  // namespace palmar::records
