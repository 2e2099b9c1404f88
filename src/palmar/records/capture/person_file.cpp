// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/capture/person_file.h"

#include <fmt/format.h>

#include "palmar/core/nearest_name.h"
#include "palmar/formats/file.h"
#include "palmar/formats/toml_section.h"
#include "palmar/records/capture/mark_label_file.h"

namespace palmar {
namespace {

constexpr std::uint64_t kMostBytes = 1 << 20;
constexpr double kFarthest = 1e5;  // of a coordinate, in any unit

std::optional<Vec3> point_of(const TomlSection& section, const char* key, const char* unit) {
  if (!section.has(key)) return {};
  const std::vector<double> values = section.numbers(key, unit, -kFarthest, kFarthest);
  if (values.size() != 3) {
    section.fail(key, fmt::format("{} numbers; three are required: x, y, z", values.size()));
  }
  return Vec3(values[0], values[1], values[2]);
}

Vec3 need_point(const TomlSection& section) {
  const auto point = point_of(section, "at_mm", "mm");
  if (!point) section.fail("at_mm is missing: where it is, [x, y, z]");
  return *point;
}

std::string place_of(const TomlSection& section) {
  return section.path() + ":" + std::to_string(section.values().source().begin.line);
}

std::optional<MarkLabel> mark_of(const TomlSection& section) {
  section.allow({"posture", "mark", "name", "at_mm"});
  MarkText text;
  text.posture = section.text("posture").value_or("reference");
  text.mark = section.need_text("mark");
  text.name = section.text("name").value_or("");
  text.point = need_point(section);
  text.place = place_of(section);
  return mark_label_of(text, [&section](const std::string& why) { section.fail(why); });
}

BoneLabel bone_of(const TomlSection& section) {
  section.allow({"name", "at_mm"});
  return {section.need_text("name"), need_point(section), place_of(section)};
}

std::vector<SizedDimension> sizes_of(const TomlSection& section) {
  constexpr double kMost = 500.0;  // mm
  std::vector<SizedDimension> sizes;
  for (const auto& [key, node] : section.values()) {
    const std::string name(key.str());
    const auto dimension = hand_dimension_named(name);
    if (!dimension) {
      std::vector<std::string> names;
      for (const HandDimension& one : all_hand_dimensions()) names.push_back(name_of(one));
      section.fail(name, fmt::format("no dimension of a hand has this name; the nearest is \"{}\"",
                                     nearest_name(name, names)));
    }
    sizes.push_back({*dimension, section.need_number(name, "mm", 1.0, kMost)});
  }
  return sizes;
}

}  // namespace

PersonFile read_person(const std::string& path) {
  const toml::table table = parse_toml(read_file(path, kMostBytes), path);
  const TomlSection file(path, "", table);
  file.allow({"side", "scan", "mark", "bone", "measured_mm"});
  PersonFile person;
  if (const auto side = file.text("side")) {
    if (*side != "right" && *side != "left") {
      file.fail("side", "\"" + *side + "\"; right or left is allowed");
    }
    person.side = *side == "left" ? Side::kLeft : Side::kRight;
  }
  if (const auto scan = file.table("scan")) {
    scan->allow({"pick_crease", "pick_dot"});
    person.pick_crease = point_of(*scan, "pick_crease", "");
    person.pick_dot = point_of(*scan, "pick_dot", "");
  }
  for (const TomlSection& section : file.tables("mark")) {
    if (const auto mark = mark_of(section)) person.marks.push_back(*mark);
  }
  for (const TomlSection& section : file.tables("bone")) person.bones.push_back(bone_of(section));
  if (const auto sizes = file.table("measured_mm")) person.sizes = sizes_of(*sizes);
  return person;
}

}  // namespace palmar
