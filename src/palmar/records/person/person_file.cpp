// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/person/person_file.h"

#include <fmt/format.h>

#include "palmar/core/nearest_name.h"
#include "palmar/formats/file.h"
#include "palmar/formats/toml_section.h"

namespace palmar::records {
namespace {

constexpr double kFarthestCoordinate = 1e5;  // of a coordinate, in any unit

std::optional<Vec3> point_of(const formats::TomlSection& section, const char* key,
                             const char* unit) {
  if (!section.has(key)) return {};
  const std::vector<double> values =
      section.numbers(key, unit, -kFarthestCoordinate, kFarthestCoordinate);
  if (values.size() != 3) {
    section.fail(key, fmt::format("{} numbers; three are required: x, y, z", values.size()));
  }
  return Vec3(values[0], values[1], values[2]);
}

Vec3 need_point(const formats::TomlSection& section) {
  const auto point = point_of(section, "at_mm", "mm");
  if (!point) section.fail("at_mm is missing: where it is, [x, y, z]");
  return *point;
}

std::string place_of(const formats::TomlSection& section) {
  return section.path() + ":" + std::to_string(section.values().source().begin.line);
}

std::optional<hand::MarkLabel> mark_of(const formats::TomlSection& section) {
  section.allow({"posture", "mark", "name", "at_mm"});
  MarkText text;
  text.posture = section.text("posture").value_or("reference");
  text.mark = section.need_text("mark");
  text.name = section.text("name").value_or("");
  text.point = need_point(section);
  text.place = place_of(section);
  return mark_label_of(text, [&section](const std::string& why) { section.fail(why); });
}

std::optional<hand::BoneLabel> bone_of(const formats::TomlSection& section) {
  section.allow({"name", "at_mm"});
  hand::BoneLabel bone{section.need_text("name"), need_point(section), place_of(section)};
  if (bone.name.empty()) return {};
  return bone;
}

std::vector<hand::SizedDimension> sizes_of(const formats::TomlSection& section) {
  constexpr double kMost = 500.0;  // mm
  std::vector<hand::SizedDimension> sizes;
  for (const auto& [key, node] : section.values()) {
    const std::string name(key.str());
    const auto dimension = hand::hand_dimension_named(name);
    if (!dimension) {
      std::vector<std::string> names;
      for (const hand::HandDimension& one : hand::all_hand_dimensions())
        names.push_back(name_of(one));
      section.fail(name, fmt::format("no dimension of a hand has this name; the nearest is \"{}\"",
                                     nearest_name(name, names)));
    }
    sizes.push_back({*dimension, section.need_number(name, "mm", 1.0, kMost)});
  }
  return sizes;
}

std::string list_of(const Vec3& point) {
  return "[" + formats::toml_number(point.x()) + ", " + formats::toml_number(point.y()) + ", " +
         formats::toml_number(point.z()) + "]";
}

std::string head_of(const char* table, std::string_view comment) {
  return fmt::format("[[{}]]{}{}\n", table, comment.empty() ? "" : "  # ", comment);
}

}  // namespace

bool PersonFile::is_empty() const {
  return !side && !pick_crease && !pick_dot && marks.empty() && bones.empty() && sizes.empty();
}

PersonFile merged(PersonFile person, const PersonFile& more) {
  if (more.side) person.side = more.side;
  if (more.pick_crease) person.pick_crease = more.pick_crease;
  if (more.pick_dot) person.pick_dot = more.pick_dot;
  person.marks.insert(person.marks.end(), more.marks.begin(), more.marks.end());
  person.bones.insert(person.bones.end(), more.bones.begin(), more.bones.end());
  for (const hand::SizedDimension& one : more.sizes) {
    std::erase_if(person.sizes,
                  [&one](const auto& other) { return other.dimension == one.dimension; });
    person.sizes.push_back(one);
  }
  return person;
}

PersonFile read_person(const std::string& path) {
  return parse_person(formats::read_file(path, kMostPersonBytes), path);
}

PersonFile parse_person(const std::string& text, const std::string& path) {
  const toml::table table = formats::parse_toml(text, path);
  const formats::TomlSection file(path, "", table);
  file.allow({"side", "scan", "mark", "bone", "measured_mm"});
  PersonFile person;
  if (const auto side = file.text("side")) {
    if (*side != "right" && *side != "left") {
      file.fail("side", "\"" + *side + "\"; right or left is allowed");
    }
    person.side = *side == "left" ? hand::Side::kLeft : hand::Side::kRight;
  }
  if (const auto scan = file.table("scan")) {
    scan->allow({"pick_crease", "pick_dot"});
    person.pick_crease = point_of(*scan, "pick_crease", "");
    person.pick_dot = point_of(*scan, "pick_dot", "");
  }
  for (const formats::TomlSection& section : file.tables("mark")) {
    if (const auto mark = mark_of(section)) person.marks.push_back(*mark);
  }
  for (const formats::TomlSection& section : file.tables("bone")) {
    if (const auto bone = bone_of(section)) person.bones.push_back(*bone);
  }
  if (const auto sizes = file.table("measured_mm")) person.sizes = sizes_of(*sizes);
  return person;
}

std::string format_person_mark(const MarkText& mark, std::string_view comment) {
  return head_of("mark", comment) + "posture = " + formats::toml_string(mark.posture) +
         "\nmark = " + formats::toml_string(mark.mark) +
         "\nname = " + formats::toml_string(mark.name) + "\nat_mm = " + list_of(mark.point) + "\n";
}

std::string format_person_bone(const hand::BoneLabel& bone, std::string_view comment) {
  return head_of("bone", comment) + "name = " + formats::toml_string(bone.name) +
         "\nat_mm = " + list_of(bone.point) + "\n";
}

std::string format_person(const PersonFile& person) {
  std::string text;
  if (person.side)
    text += "side = " + formats::toml_string(std::string(name_of(*person.side))) + "\n";
  if (person.pick_crease || person.pick_dot) text += "\n[scan]\n";
  if (person.pick_crease) text += "pick_crease = " + list_of(*person.pick_crease) + "\n";
  if (person.pick_dot) text += "pick_dot = " + list_of(*person.pick_dot) + "\n";
  for (const hand::MarkLabel& one : person.marks)
    text += "\n" + format_person_mark(mark_text_of(one));
  for (const hand::BoneLabel& one : person.bones) text += "\n" + format_person_bone(one);
  if (!person.sizes.empty()) text += "\n[measured_mm]\n";
  for (const hand::SizedDimension& one : person.sizes) {
    text += name_of(one.dimension) + " = " + formats::toml_number(one.value) + "\n";
  }
  if (text.starts_with('\n')) text.erase(0, 1);
  return text;
}

}  // namespace palmar::records
