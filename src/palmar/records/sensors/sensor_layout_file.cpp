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

namespace palmar {
namespace {

constexpr std::uint64_t kMostLayoutBytes = 1 << 20;  // a thousand free sensors have 80 kB
constexpr double kFarthestSensor = 5000.0;           // mm

std::optional<Vec3> read_vector(const TomlSection& section, std::string_view key,
                                std::string_view unit, double farthest) {
  if (!section.has(key)) return std::nullopt;
  const std::vector<double> values = section.numbers(key, unit, -farthest, farthest);
  if (values.size() != 3) {
    section.fail(key, fmt::format("has {} number{}; 3 are required: [x, y, z]", values.size(),
                                  values.size() == 1 ? "" : "s"));
  }
  return Vec3(values[0], values[1], values[2]);
}

int need_count(const TomlSection& section, std::string_view key) {
  const auto count = section.integer(key, 1, kMostSensorRows);
  if (!count) section.fail(fmt::format("{} is missing", key));
  return static_cast<int>(*count);
}

SensorKind read_kind(const TomlSection& file) {
  const std::string name = file.need_text("kind");
  for (const SensorKind kind : {SensorKind::kMat, SensorKind::kGlove, SensorKind::kFree}) {
    if (name == name_of(kind)) return kind;
  }
  file.fail("kind",
            fmt::format("is \"{}\", which is not known; mat, glove or free is allowed", name));
}

SensorPatch read_patch(const TomlSection& section) {
  section.allow({"region", "rows", "columns"});
  const std::string name = section.need_text("region");
  const std::optional<Region> region = region_named(name);
  if (!region || *region == Region::kDorsum) {
    std::vector<std::string> known;
    for (int r = 1; r < kRegionCount; ++r) known.emplace_back(name_of(static_cast<Region>(r)));
    section.fail("region", fmt::format("is \"{}\", which is no palmar region; {}", name,
                                       did_you_mean(name, known, "index_distal is one")));
  }
  return {*region, need_count(section, "rows"), need_count(section, "columns")};
}

FreeSensor read_sensor(const TomlSection& section) {
  section.allow({"name", "at_mm", "area_mm2"});
  FreeSensor sensor;
  sensor.name = section.need_text("name");
  const std::optional<Vec3> at = read_vector(section, "at_mm", "mm", kFarthestSensor);
  if (!at) section.fail("at_mm is missing");
  sensor.at = *at;
  sensor.area = section.need_number("area_mm2", "mm2", 0.01, kMostSensorArea);
  return sensor;
}

SensorLayout read_layout(const std::string& path) {
  const toml::table table = parse_toml(read_file(path, kMostLayoutBytes), path);
  const TomlSection file(path, "", table);
  SensorLayout layout;
  layout.kind = read_kind(file);
  layout.name = file.need_text("name");
  layout.source = file.text("source").value_or(path);
  std::vector<std::string> keys = {"name", "kind", "source"};
  const auto add = [&](std::initializer_list<const char*> more) {
    keys.insert(keys.end(), more.begin(), more.end());
  };
  switch (layout.kind) {
    case SensorKind::kMat:
      add({"pitch_mm", "rows", "columns", "origin_mm", "axis", "seam"});
      break;
    case SensorKind::kGlove:
      add({"pitch_mm", "patch"});
      break;
    case SensorKind::kFree:
      add({"sensor"});
      break;
  }
  file.allow(keys);
  if (layout.kind != SensorKind::kFree) {
    layout.pitch = file.need_number("pitch_mm", "mm", kFinestPitch, kCoarsestPitch);
  }
  if (layout.kind == SensorKind::kMat) {
    layout.rows = need_count(file, "rows");
    layout.columns = static_cast<int>(file.integer("columns", 1, kMostSensorRows).value_or(0));
    layout.origin = read_vector(file, "origin_mm", "mm", kFarthestSensor);
    layout.axis = read_vector(file, "axis", "", kFarthestSensor);
    layout.seam = read_vector(file, "seam", "", kFarthestSensor);
  }
  for (const TomlSection& patch : file.tables("patch")) layout.patches.push_back(read_patch(patch));
  for (const TomlSection& one : file.tables("sensor")) layout.sensors.push_back(read_sensor(one));
  try {
    layout.check();
  } catch (const UsageError& error) {
    throw InputError(path + ": " + error.what());
  }
  return layout;
}

}  // namespace

SensorLayout read_sensor_layout(const std::string& name_or_file) {
  if (const auto layout = sensor_layout_named(name_or_file)) return *layout;
  if (name_or_file.find_first_of("./\\") != std::string::npos) return read_layout(name_or_file);
  std::vector<std::string> known;
  std::string list;
  for (const SensorLayout& one : sensor_layouts()) {
    known.push_back(one.name);
    list += (list.empty() ? "" : ", ") + one.name;
  }
  throw UsageError(fmt::format("sensor layout \"{}\" is not known; {}", name_or_file,
                               did_you_mean(name_or_file, known, list + " or a .toml file")));
}

}  // namespace palmar
