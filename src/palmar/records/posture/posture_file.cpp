// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/posture/posture_file.h"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/core/nearest_name.h"
#include "palmar/formats/csv_reader.h"
#include "palmar/formats/file.h"
#include "palmar/formats/json_reason.h"
#include "palmar/formats/text_scan.h"
#include "palmar/geometry/degrees.h"
#include "palmar/records/posture/placement_json.h"

namespace palmar::records {
namespace {

using PlainJson = nlohmann::json;

constexpr std::uint64_t kMaxPostureBytes = std::uint64_t{1} << 30;
constexpr double kFullTurn = 2.0 * std::numbers::pi;

/// What a name in a file means.
struct AngleName {
  hand::Dof dof{};
  double factor = 1.0;  ///< to rad
};

std::vector<std::string> known_names() {
  std::vector<std::string> names;
  for (int d = 0; d < hand::kDofCount; ++d) {
    names.push_back(std::string(name_of(static_cast<hand::Dof>(d))) + "_deg");
  }
  return names;
}

/// Throws InputError without the place if the name is none.
AngleName angle_named(const std::string& name) {
  const auto ends = [&](std::string_view end) { return name.size() > 4 && name.ends_with(end); };
  if (ends("_deg") || ends("_rad")) {
    if (const auto dof = hand::dof_named(name.substr(0, name.size() - 4))) {
      return {*dof, ends("_deg") ? geometry::kDegree : 1.0};
    }
  } else if (hand::dof_named(name)) {
    throw InputError(formats::in_quotes(name) + " has no unit; " + name + "_deg or " + name +
                     "_rad is needed");
  }
  std::string stem = name;
  if (ends("_rad")) stem = name.substr(0, name.size() - 4) + "_deg";
  if (!ends("_rad") && !ends("_deg")) stem += "_deg";
  throw InputError(
      formats::in_quotes(name) + " is no joint angle; " +
      did_you_mean(stem, known_names(), "`palmar hand info` lists the degrees of freedom"));
}

/// Angles of one frame as they are read.
class AngleSet {
 public:
  /// Throws InputError without the place.
  void set(const std::string& name, double value) {
    const AngleName known = angle_named(name);
    std::optional<double>& angle = angle_[index_of(known.dof)];
    if (angle)
      throw InputError(formats::in_quotes(name) + " is given twice (in degrees and in radians?)");
    if (!std::isfinite(value)) throw InputError(formats::in_quotes(name) + " is not finite");
    const double radians = value * known.factor;
    if (std::abs(radians) > kFullTurn) {
      const bool is_rad = known.factor == 1.0;
      throw InputError(formats::in_quotes(name) + " is " + formats::shortest(value) +
                       (is_rad ? " rad" : " deg") + ", more than a full turn" +
                       (is_rad ? "; is it in degrees (_deg)?" : ""));
    }
    angle = radians;
    is_empty_ = false;
  }
  bool is_empty() const { return is_empty_; }

  void give(const hand::Skeleton& skeleton, PostureFrame& frame) const {
    hand::Posture asked = hand::reference_posture(skeleton);
    for (int d = 0; d < hand::kDofCount; ++d) {
      const std::optional<double>& angle = angle_[d];
      if (angle) {
        asked[static_cast<hand::Dof>(d)] = *angle;
      } else {
        frame.missing.push_back(static_cast<hand::Dof>(d));
      }
    }
    hand::ClampedPosture held = hand::clamp_to_range(skeleton, asked);
    frame.posture = held.posture;
    // Written in degrees and read back, a limit may come out one rounding beyond itself.
    constexpr double kRounding = 1e-12;  // rad
    std::erase_if(held.clamped, [](const hand::ClampedAngle& one) {
      return std::abs(one.asked - one.used) < kRounding;
    });
    frame.clamped = std::move(held.clamped);
  }

 private:
  std::array<std::optional<double>, hand::kDofCount> angle_;
  bool is_empty_ = true;
};

class JsonPostures {
 public:
  JsonPostures(const std::string& path, const hand::Skeleton& skeleton)
      : path_(path), skeleton_(&skeleton) {}

  PostureFile read(const std::string& text) {
    PlainJson json;
    try {
      json = PlainJson::parse(text);
    } catch (const PlainJson::exception& error) {
      throw InputError(path_ + ": no valid JSON: " + formats::json_reason(error));
    }
    if (json.is_array()) {
      read_list(json, "entry");
    } else if (json.is_object() && json.contains("frames")) {
      read_list(json["frames"], "frame");
    } else if (json.is_object() && json.contains("assessments")) {
      read_list(json["assessments"], "assessment");
    } else {
      read_frame(json, "");
    }
    return std::move(file_);
  }

 private:
  [[noreturn]] void fail(const std::string& place, const std::string& why) const {
    throw InputError(path_ + ": " + (place.empty() ? "" : place + ": ") + why);
  }

  void read_list(const PlainJson& list, const std::string& what) {
    if (!list.is_array() || list.empty()) fail("", what + "s: a list with at least one is needed");
    for (std::size_t i = 0; i < list.size(); ++i) {
      read_frame(list[i], what + " " + std::to_string(i + 1));
    }
  }

  void read_frame(const PlainJson& json, const std::string& name) {
    if (!json.is_object()) fail(name, "an object with joint angles is needed");
    if (json.contains("grasp")) {
      read_frame(json["grasp"], name);
      return;
    }
    PostureFrame frame;
    frame.name = name;
    AngleSet angles;
    const bool is_wrapped = json.contains("posture");
    if (is_wrapped && !json["posture"].is_object()) {
      fail(name, "\"posture\" is no object with joint angles");
    }
    for (const auto& [key, value] : (is_wrapped ? json["posture"] : json).items()) {
      if (!is_wrapped && (key == "time_s" || key == "frame" || key == "name" || key == "source" ||
                          key == "comment" || key == "product_from_hand" || key == "grip")) {
        continue;
      }
      if (value.is_null()) continue;
      try {
        if (!value.is_number()) {
          throw InputError(formats::in_quotes(key) + " is " + formats::in_quotes(value.dump()) +
                           "; a number is needed");
        }
        angles.set(key, value.get<double>());
      } catch (const InputError& error) {
        fail(name, error.what());
      }
    }
    if (angles.is_empty()) fail(name, "it has no joint angle, such as index_pip_flexion_deg");
    angles.give(*skeleton_, frame);
    if (json.contains("time_s") && json["time_s"].is_number()) {
      frame.time = json["time_s"].get<double>();
    }
    const auto placement = [&](const char* key, std::optional<geometry::Rigid3>& to) {
      if (!json.contains(key)) return;
      try {
        to = placement_from_json(json[key]);
      } catch (const InputError& error) {
        fail(name, std::string(key) + ": " + error.what());
      }
    };
    placement("product_from_hand", frame.product_from_hand);
    placement("measured_from_hand", frame.measured_from_hand);
    placement("mesh_from_hand", frame.measured_from_hand);
    if (json.contains("grip") && json["grip"].is_string()) {
      const auto grip = json["grip"].get<std::string>();
      frame.grip = grasp::grip_named(grip);
      if (!frame.grip) fail(name, "grip " + formats::in_quotes(grip) + " is not known");
    }
    file_.frames.push_back(std::move(frame));
  }

  std::string path_;
  const hand::Skeleton* skeleton_;
  PostureFile file_;
};

/// Columns beside the angles that Palmar itself writes or that need no word.
bool is_side_column(std::string_view name) {
  return name == "frame" || name == "time_s" || name == "rms_mm" || name == "name" ||
         name == "comment";
}

PostureFile read_csv_postures(const formats::CsvFile& csv, const hand::Skeleton& skeleton) {
  PostureFile file;
  for (const std::string& name : csv.header) {
    if (is_side_column(name)) continue;
    try {
      angle_named(name);
    } catch (const InputError& error) {
      csv.fail(csv.header_line, std::string("column ") + error.what());
    }
  }
  const int time = csv.column("time_s");
  if (csv.rows.empty()) throw InputError(csv.path + ": it has no angles below the header");
  for (const formats::CsvFile::Row& row : csv.rows) {
    PostureFrame frame;
    frame.name = "frame " + std::to_string(file.frames.size() + 1);
    AngleSet angles;
    for (std::size_t c = 0; c < csv.header.size(); ++c) {
      if (is_side_column(csv.header[c]) || row.cells[c].empty()) continue;
      try {
        angles.set(csv.header[c], csv.number(row, c));
      } catch (const InputError& error) {
        const std::string what = error.what();
        if (what.starts_with(csv.path)) throw;
        csv.fail(row.line, what);
      }
    }
    if (angles.is_empty()) {
      csv.fail(row.line, "it has no joint angle, such as index_pip_flexion_deg");
    }
    if (time >= 0 && !row.cells[time].empty()) {
      frame.time = csv.number(row, static_cast<std::size_t>(time));
    }
    angles.give(skeleton, frame);
    file.frames.push_back(std::move(frame));
  }
  if (file.frames.size() == 1) file.frames.front().name.clear();
  return file;
}

}  // namespace

PostureFile read_postures(const std::string& path, const hand::Skeleton& skeleton) {
  const std::string text = formats::read_file(path, kMaxPostureBytes);
  if (!formats::looks_like_text(std::string_view(text).substr(0, 4096))) {
    throw InputError(path + ": no text; joint angles as JSON or CSV are needed");
  }
  const std::size_t start = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (start != text.npos && (text[start] == '{' || text[start] == '[')) {
    return JsonPostures(path, skeleton).read(text);
  }
  return read_csv_postures(formats::parse_csv(text, path), skeleton);
}

const PostureFrame& frame_of(const PostureFile& file, const std::string& path,
                             std::optional<int> which) {
  const auto count = static_cast<int>(file.frames.size());
  if (!which && count > 1) {
    throw InputError(path + ": it has " + std::to_string(count) +
                     " postures; say which one by setting \"frame\", from 1");
  }
  const int wanted = which.value_or(1);
  if (wanted < 1 || wanted > count) {
    throw UsageError(path + ": posture " + std::to_string(wanted) + " is requested; there " +
                     (count == 1 ? "is one" : "are " + std::to_string(count)));
  }
  return file.frames[wanted - 1];
}

std::string posture_json(const hand::Posture& posture) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (int d = 0; d < hand::kDofCount; ++d) {
    const auto dof = static_cast<hand::Dof>(d);
    json[std::string(name_of(dof)) + "_deg"] = posture[dof] / geometry::kDegree;
  }
  return json.dump(2);
}

}  // namespace palmar::records
