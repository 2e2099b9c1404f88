// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/motion/marker_file.h"

#include <array>
#include <cctype>
#include <cmath>

#include "palmar/core/error.h"
#include "palmar/formats/csv_reader.h"
#include "palmar/formats/file.h"
#include "palmar/formats/motion/c3d.h"
#include "palmar/formats/text_scan.h"

namespace palmar::formats {
namespace {

/// One coordinate of a marker.
struct Coordinate {
  std::string label;
  int axis = 0;
  std::optional<geometry::LengthUnit> unit;
};

/// Nothing if the column is none.
std::optional<Coordinate> coordinate_of(const std::string& column) {
  Coordinate coordinate;
  std::string name = column;
  if (const auto last = name.rfind('_'); last != name.npos) {
    coordinate.unit = geometry::length_unit_named(std::string_view(name).substr(last + 1));
    if (coordinate.unit) name.resize(last);
  }
  if (name.size() < 3 || name[name.size() - 2] != '_') return std::nullopt;
  const auto axis = static_cast<char>(std::tolower(static_cast<unsigned char>(name.back())));
  if (axis < 'x' || axis > 'z') return std::nullopt;
  coordinate.axis = axis - 'x';
  coordinate.label = name.substr(0, name.size() - 2);
  return coordinate;
}

MarkerRecording read_csv_markers(const CsvFile& csv, std::optional<geometry::LengthUnit> unit) {
  struct Columns {
    std::array<int, 3> column = {-1, -1, -1};
    std::array<double, 3> factor = {1.0, 1.0, 1.0};
  };
  MarkerRecording recording;
  recording.format = "CSV";
  std::vector<Columns> markers;
  std::string ignored;
  for (std::size_t c = 0; c < csv.header.size(); ++c) {
    const std::string& name = csv.header[c];
    if (name == "frame" || name == "time_s") continue;
    const auto coordinate = coordinate_of(name);
    if (!coordinate) {
      ignored += (ignored.empty() ? "" : ", ") + name;
      continue;
    }
    if (!coordinate->unit && !unit) {
      csv.fail(csv.header_line, "column " + in_quotes(name) + " has no unit; " + name +
                                    "_mm (or _cm, _m, _in) is needed, or setting \"unit\"");
    }
    std::size_t i = 0;
    while (i < recording.labels.size() && recording.labels[i] != coordinate->label) ++i;
    if (i == recording.labels.size()) {
      recording.labels.push_back(coordinate->label);
      markers.emplace_back();
    }
    const auto axis = static_cast<std::size_t>(coordinate->axis);
    if (markers[i].column[axis] >= 0) {
      csv.fail(csv.header_line,
               "columns " +
                   in_quotes(csv.header[static_cast<std::size_t>(markers[i].column[axis])]) +
                   " and " + in_quotes(name) + " say the same");
    }
    markers[i].column[axis] = static_cast<int>(c);
    markers[i].factor[axis] = geometry::millimetres_per(unit ? *unit : *coordinate->unit);
  }
  if (markers.empty()) {
    csv.fail(csv.header_line,
             "it has no markers; columns such as index_nail_x_mm, "
             "index_nail_y_mm, index_nail_z_mm are needed");
  }
  for (std::size_t i = 0; i < markers.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (markers[i].column[axis] < 0) {
        csv.fail(csv.header_line, "marker " + in_quotes(recording.labels[i]) + " has no column _" +
                                      std::string(1, static_cast<char>('x' + axis)));
      }
    }
  }
  if (!ignored.empty()) recording.notes.push_back("columns left out: " + ignored);
  if (csv.rows.empty()) throw InputError(csv.path + ": it has no frames below the header");

  const int frame_column = csv.column("frame"), time_column = csv.column("time_s");
  for (const CsvFile::Row& row : csv.rows) {
    MarkerRecording::Frame frame;
    frame.number = static_cast<int>(recording.frames.size()) + 1;
    if (frame_column >= 0) {
      const double number = csv.number(row, static_cast<std::size_t>(frame_column));
      if (std::abs(number) > 1e9 || number != std::floor(number)) {
        csv.fail(row.line, "frame is " +
                               in_quotes(row.cells[static_cast<std::size_t>(frame_column)]) +
                               "; a whole number is needed");
      }
      frame.number = static_cast<int>(number);
    }
    if (time_column >= 0 && !row.cells[static_cast<std::size_t>(time_column)].empty()) {
      frame.time = csv.number(row, static_cast<std::size_t>(time_column));
    }
    for (const Columns& marker : markers) {
      Vec3 p = Vec3::Zero();
      int seen = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto column = static_cast<std::size_t>(marker.column[axis]);
        const std::string& cell = row.cells[column];
        const std::optional<double> value = parse_double(cell);
        if (cell.empty() || (value && std::isnan(*value))) continue;
        p[static_cast<Eigen::Index>(axis)] = marker.factor[axis] * csv.number(row, column);
        ++seen;
      }
      if (seen != 0 && seen != 3) {
        const auto label = recording.labels[frame.position.size()];
        csv.fail(row.line, "marker " + in_quotes(label) + " has " + std::to_string(seen) +
                               " of 3 coordinates; all or none are needed");
      }
      frame.position.push_back(seen == 3 ? std::optional<Vec3>(p) : std::nullopt);
    }
    recording.frames.push_back(std::move(frame));
  }
  return recording;
}

}  // namespace

MarkerRecording read_markers(const std::string& path, std::optional<geometry::LengthUnit> unit) {
  const std::string bytes = read_file(path);
  if (looks_like_text(std::string_view(bytes).substr(0, 4096))) {
    return read_csv_markers(parse_csv(bytes, path), unit);
  }
  if (is_c3d(bytes)) return parse_c3d(bytes, path, unit);
  throw InputError(path + ": no marker positions that Palmar knows; C3D and CSV are read");
}

}  // namespace palmar::formats
