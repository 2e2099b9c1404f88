// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/sensors/sensor_layout_file.h"

#include <fmt/format.h>

#include <string_view>
#include <vector>

#include "palmar/core/error.h"
#include "palmar/core/nearest_name.h"
#include "palmar/formats/file.h"
#include "palmar/formats/toml_section.h"

namespace palmar::records {
namespace {

constexpr std::uint64_t kMostLayoutBytes = 1 << 20;  // a thousand free sensors have 80 kB
constexpr double kFarthestSensor = 5000.0;           // mm

std::optional<Vec3> read_vector(const formats::TomlSection& section, std::string_view key,
                                std::string_view unit, double farthest) {
  if (!section.has(key)) return std::nullopt;
  const std::vector<double> values = section.numbers(key, unit, -farthest, farthest);
  if (values.size() != 3) {
    section.fail(key, fmt::format("has {} number{}; 3 are required: [x, y, z]", values.size(),
                                  values.size() == 1 ? "" : "s"));
  }
  return Vec3(values[0], values[1], values[2]);
}

int need_count(const formats::TomlSection& section, std::string_view key) {
  const auto count = section.integer(key, 1, study::kMostSensorRows);
  if (!count) section.fail(fmt::format("{} is missing", key));
  return static_cast<int>(*count);
}

study::SensorKind read_kind(const formats::TomlSection& file) {
  const std::string name = file.need_text("kind");
  for (const study::SensorKind kind :
       {study::SensorKind::kMat, study::SensorKind::kGlove, study::SensorKind::kFree}) {
    if (name == name_of(kind)) return kind;
  }
  file.fail("kind",
            fmt::format("is \"{}\", which is not known; mat, glove or free is allowed", name));
}

study::SensorPatch read_patch(const formats::TomlSection& section) {
  section.allow({"region", "rows", "columns"});
  const std::string name = section.need_text("region");
  const std::optional<hand::Region> region = hand::region_named(name);
  if (!region || *region == hand::Region::kDorsum) {
    std::vector<std::string> known;
    for (int r = 1; r < hand::kRegionCount; ++r)
      known.emplace_back(name_of(static_cast<hand::Region>(r)));
    section.fail("region", fmt::format("is \"{}\", which is no palmar region; {}", name,
                                       did_you_mean(name, known, "index_distal is one")));
  }
  return {*region, need_count(section, "rows"), need_count(section, "columns")};
}

study::FreeSensor read_sensor(const formats::TomlSection& section) {
  section.allow({"name", "at_mm", "area_mm2"});
  study::FreeSensor sensor;
  sensor.name = section.need_text("name");
  const std::optional<Vec3> at = read_vector(section, "at_mm", "mm", kFarthestSensor);
  if (!at) section.fail("at_mm is missing");
  sensor.at = *at;
  sensor.area = section.need_number("area_mm2", "mm2", 0.01, study::kMostSensorArea);
  return sensor;
}

study::SensorLayout read_layout(const std::string& path) {
  const toml::table table = formats::parse_toml(formats::read_file(path, kMostLayoutBytes), path);
  const formats::TomlSection file(path, "", table);
  study::SensorLayout layout;
  layout.kind = read_kind(file);
  layout.name = file.need_text("name");
  layout.source = file.text("source").value_or(path);
  std::vector<std::string> keys = {"name", "kind", "source"};
  const auto add = [&](std::initializer_list<const char*> more) {
    keys.insert(keys.end(), more.begin(), more.end());
  };
  switch (layout.kind) {
    case study::SensorKind::kMat:
      add({"pitch_mm", "rows", "columns", "origin_mm", "axis", "seam"});
      break;
    case study::SensorKind::kGlove:
      add({"pitch_mm", "patch"});
      break;
    case study::SensorKind::kFree:
      add({"sensor"});
      break;
  }
  file.allow(keys);
  if (layout.kind != study::SensorKind::kFree) {
    layout.pitch = file.need_number("pitch_mm", "mm", study::kFinestPitch, study::kCoarsestPitch);
  }
  if (layout.kind == study::SensorKind::kMat) {
    layout.rows = need_count(file, "rows");
    layout.columns =
        static_cast<int>(file.integer("columns", 1, study::kMostSensorRows).value_or(0));
    layout.origin = read_vector(file, "origin_mm", "mm", kFarthestSensor);
    layout.axis = read_vector(file, "axis", "", kFarthestSensor);
    layout.seam = read_vector(file, "seam", "", kFarthestSensor);
  }
  for (const formats::TomlSection& patch : file.tables("patch"))
    layout.patches.push_back(read_patch(patch));
  for (const formats::TomlSection& one : file.tables("sensor"))
    layout.sensors.push_back(read_sensor(one));
  try {
    layout.check();
  } catch (const UsageError& error) {
    throw InputError(path + ": " + error.what());
  }
  return layout;
}

}  // namespace

study::SensorLayout read_sensor_layout(const std::string& name_or_file) {
  if (const auto layout = study::sensor_layout_named(name_or_file)) return *layout;
  if (name_or_file.find_first_of("./\\") != std::string::npos) return read_layout(name_or_file);
  std::vector<std::string> known;
  std::string list;
  for (const study::SensorLayout& one : study::sensor_layouts()) {
    known.push_back(one.name);
    list += (list.empty() ? "" : ", ") + one.name;
  }
  throw UsageError(fmt::format("sensor layout \"{}\" is not known; {}", name_or_file,
                               did_you_mean(name_or_file, known, list + " or a .toml file")));
}

}  // namespace palmar::records
