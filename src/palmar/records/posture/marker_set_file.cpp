// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/posture/marker_set_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "palmar/core/error.h"
#include "palmar/core/nearest_name.h"
#include "palmar/core/text.h"
#include "palmar/formats/csv_reader.h"
#include "palmar/formats/file.h"
#include "palmar/formats/json_reason.h"
#include "palmar/formats/text_scan.h"
#include "palmar/hand/skin/landmarks.h"

namespace palmar::records {
namespace {

using PlainJson = nlohmann::json;

constexpr std::uint64_t kMostMarkerBytes = std::uint64_t{1} << 26;
constexpr double kFarFromSkin = 60.0;  // mm; wands stand off less
constexpr std::size_t kFewest = 4;     // markers, as in posture_fit.h

/// One marker as a file has it.
struct Entry {
  std::string place;  ///< "file:12", for messages
  std::string label, landmark, part;
  std::optional<double> vertex, height;
  std::optional<Vec3> point;
};

class Builder {
 public:
  explicit Builder(const hand::Hand& hand) : hand_(&hand), landmarks_(hand) {}

  void add(const Entry& entry) {
    if (entry.label.empty()) fail(entry, "a marker has no label");
    if (!taken_.insert(entry.label).second) fail(entry, "this label appears twice");
    const int places =
        (entry.landmark.empty() ? 0 : 1) + (entry.vertex ? 1 : 0) + (entry.point ? 1 : 0);
    if (places != 1) {
      fail(entry, fmt::format("{} of landmark, vertex and point are given; one is needed", places));
    }
    if (!entry.part.empty() && !entry.point) {
      fail(entry, "part needs a point (x_mm, y_mm, z_mm)");
    }
    if (entry.height && entry.point) fail(entry, "height_mm needs a landmark or a vertex");
    const double height = entry.height.value_or(0.0);
    if (!(std::abs(height) <= kFarFromSkin)) {
      fail(entry,
           fmt::format("height_mm is {:g}; at most {:g} mm is allowed", height, kFarFromSkin));
    }
    try {
      set_.point.push_back(point_of(entry, height));
    } catch (const UsageError& error) {
      fail(entry, error.what());
    }
    set_.label.push_back(entry.label);
  }

  hand::MarkerSet finish(const std::string& path) {
    if (set_.label.empty()) throw InputError(path + ": it has no markers");
    set_.name = std::filesystem::path(path).stem().string();
    return std::move(set_);
  }

 private:
  [[noreturn]] static void fail(const Entry& entry, const std::string& why) {
    throw InputError(
        entry.place + ": " +
        (entry.label.empty() ? "" : "marker " + formats::in_quotes(entry.label) + ": ") + why);
  }

  hand::HandPoint point_of(const Entry& entry, double height) const {
    if (!entry.landmark.empty()) return landmarks_.at(entry.landmark, height);
    if (entry.vertex) {
      if (*entry.vertex != std::floor(*entry.vertex) || std::abs(*entry.vertex) > 1e9) {
        throw UsageError("vertex is no whole number");
      }
      return hand::skin_point(*hand_, static_cast<int>(*entry.vertex), height);
    }
    const hand::HandPoint near = hand::skin_point_near(*hand_, *entry.point);
    const double off = (hand_->skin.vertices[*near.vertex] - *entry.point).norm();
    if (off > kFarFromSkin) {
      throw UsageError(fmt::format(
          "the point is {:.0f} mm from the skin; at most {:g} mm is allowed (hand frame, reference "
          "posture, mm)",
          off, kFarFromSkin));
    }
    return entry.part.empty() ? near : hand::part_point(entry.part, *entry.point);
  }

  const hand::Hand* hand_;
  hand::Landmarks landmarks_;
  std::set<std::string> taken_;
  hand::MarkerSet set_;
};

const std::vector<std::string> kMarkerColumns = {"label", "landmark", "vertex", "part",
                                                 "x_mm",  "y_mm",     "z_mm",   "height_mm"};

hand::MarkerSet from_csv(const formats::CsvFile& csv, const hand::Hand& hand) {
  for (const std::string& name : csv.header) {
    if (name == "comment" ||
        std::find(kMarkerColumns.begin(), kMarkerColumns.end(), name) != kMarkerColumns.end()) {
      continue;
    }
    csv.fail(csv.header_line,
             "column " + formats::in_quotes(name) + " is not known; " +
                 did_you_mean(name, kMarkerColumns,
                              "label, landmark, vertex, part, x_mm, y_mm, z_mm and height_mm are"));
  }
  if (csv.column("label") < 0) csv.fail(csv.header_line, "column label is missing");
  Builder builder(hand);
  for (const formats::CsvFile::Row& row : csv.rows) {
    Entry entry;
    entry.place = csv.path + ":" + std::to_string(row.line);
    const auto cell = [&](const char* name) {
      const int column = csv.column(name);
      return column < 0 ? std::string() : row.cells[column];
    };
    const auto number = [&](const char* name) -> std::optional<double> {
      if (cell(name).empty()) return std::nullopt;
      return csv.number(row, static_cast<std::size_t>(csv.column(name)));
    };
    entry.label = cell("label");
    entry.landmark = cell("landmark");
    entry.part = cell("part");
    entry.vertex = number("vertex");
    entry.height = number("height_mm");
    const auto x = number("x_mm"), y = number("y_mm"), z = number("z_mm");
    if (x && y && z) {
      entry.point = Vec3(*x, *y, *z);
    } else if (x || y || z) {
      csv.fail(row.line, "a point needs x_mm, y_mm and z_mm");
    }
    builder.add(entry);
  }
  return builder.finish(csv.path);
}

hand::MarkerSet from_json(const std::string& text, const std::string& path,
                          const hand::Hand& hand) {
  PlainJson json;
  try {
    json = PlainJson::parse(text);
  } catch (const PlainJson::exception& error) {
    throw InputError(path + ": no valid JSON: " + formats::json_reason(error));
  }
  if (!json.is_object() || !json.contains("markers") || !json["markers"].is_array()) {
    throw InputError(path + ": \"markers\", a list, is needed");
  }
  Builder builder(hand);
  int index = 0;
  for (const PlainJson& one : json["markers"]) {
    Entry entry;
    entry.place = path + ": marker " + std::to_string(++index);
    if (!one.is_object()) throw InputError(entry.place + ": an object is needed");
    const auto wrong = [&](const std::string& key, const char* what) {
      throw InputError(entry.place + ": " + formats::in_quotes(key) + " is no " + what);
    };
    for (const auto& [key, value] : one.items()) {
      if (key == "label" || key == "landmark" || key == "part") {
        if (!value.is_string()) wrong(key, "text");
        (key == "label"      ? entry.label
         : key == "landmark" ? entry.landmark
                             : entry.part) = value.get<std::string>();
      } else if (key == "vertex" || key == "height_mm") {
        if (!value.is_number()) wrong(key, "number");
        (key == "vertex" ? entry.vertex : entry.height) = value.get<double>();
      } else if (key == "point_mm") {
        const bool is_point = value.is_array() && value.size() == 3 && value[0].is_number() &&
                              value[1].is_number() && value[2].is_number();
        if (!is_point) wrong(key, "list of 3 numbers");
        entry.point = Vec3(value[0].get<double>(), value[1].get<double>(), value[2].get<double>());
      } else if (key != "comment") {
        const std::string nearest =
            nearest_name(key, {"label", "landmark", "vertex", "part", "point_mm", "height_mm"});
        throw InputError(entry.place + ": " + formats::in_quotes(key) + " is not known" +
                         (nearest.empty() ? "" : "; did you mean " + nearest + "?"));
      }
    }
    builder.add(entry);
  }
  return builder.finish(path);
}

std::string plain(std::string_view label) {
  const auto colon = label.rfind(':');
  return lower_case(colon == label.npos ? label : label.substr(colon + 1));
}

/// "a, b, c, ..." with at most eight of them.
std::string some_of(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(kMost, names.size()); ++i) {
    text += (i == 0 ? "" : ", ") + names[i];
  }
  return names.size() > kMost ? text + ", ..." : text;
}

}  // namespace

hand::MarkerSet read_marker_set(const std::string& path, const hand::Hand& hand) {
  const std::string text = formats::read_file(path, kMostMarkerBytes);
  if (!formats::looks_like_text(std::string_view(text).substr(0, 4096))) {
    throw InputError(path + ": no text; a marker set as JSON or CSV is needed");
  }
  const std::size_t start = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (start != text.npos && text[start] == '{') return from_json(text, path, hand);
  return from_csv(formats::parse_csv(text, path), hand);
}

MatchedMarkers match_markers(const hand::MarkerSet& set, const formats::MarkerRecording& recording,
                             const std::string& path) {
  MatchedMarkers matched;
  matched.set.name = set.name;
  std::vector<std::size_t> column;
  std::vector<char> is_used(recording.labels.size(), 0);
  std::vector<std::string> missing;
  for (std::size_t i = 0; i < set.label.size(); ++i) {
    std::size_t found = recording.labels.size();
    for (std::size_t c = recording.labels.size(); c-- > 0;) {
      if (recording.labels[c] == set.label[i]) found = c;
    }
    for (std::size_t c = 0; found == recording.labels.size() && c < recording.labels.size(); ++c) {
      if (plain(recording.labels[c]) == plain(set.label[i])) found = c;
    }
    if (found == recording.labels.size()) {
      missing.push_back(set.label[i]);
      continue;
    }
    is_used[found] = 1;
    column.push_back(found);
    matched.set.label.push_back(set.label[i]);
    matched.set.point.push_back(set.point[i]);
  }
  if (column.size() < kFewest) {
    throw InputError(
        fmt::format("{}: {} of the marker set's {} labels are in the recording; at least {} are "
                    "needed. The set "
                    "has {}; the recording has {}",
                    path, column.size(), set.label.size(), kFewest, some_of(set.label),
                    some_of(recording.labels)));
  }
  if (!missing.empty()) {
    matched.notes.push_back(fmt::format("{} markers of the set are not in the recording: {}",
                                        missing.size(), some_of(missing)));
  }
  std::vector<std::string> unused;
  for (std::size_t c = 0; c < recording.labels.size(); ++c) {
    if (!is_used[c]) unused.push_back(recording.labels[c]);
  }
  if (!unused.empty()) {
    matched.notes.push_back(fmt::format("{} markers of the recording are not in the set: {}",
                                        unused.size(), some_of(unused)));
  }
  for (const formats::MarkerRecording::Frame& frame : recording.frames) {
    std::vector<std::optional<Vec3>> positions;
    positions.reserve(column.size());
    for (const std::size_t c : column) positions.push_back(frame.position[c]);
    matched.frames.push_back(std::move(positions));
  }
  return matched;
}

}  // namespace palmar::records
