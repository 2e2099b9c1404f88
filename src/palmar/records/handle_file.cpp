// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/handle_file.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <cmath>

#include <vector>

#include "palmar/formats/file.h"
#include "palmar/formats/toml_section.h"
#include "palmar/records/handle_json.h"

namespace palmar::records {
namespace {

constexpr std::uint64_t kMostHandleBytes = 1 << 16;
constexpr double kMostEnd = 200.0;  // mm
constexpr double kFar = 1e4;        // mm

/// A value to a thousandth: finer than anything is made.
std::string rounded(double value) {
  const double whole = std::round(value * 1000.0) / 1000.0;
  return formats::toml_number(whole == 0.0 ? 0.0 : whole);
}

std::string vector_text(const Vec3& v) {
  return fmt::format("[{}, {}, {}]", rounded(v.x()), rounded(v.y()), rounded(v.z()));
}

}  // namespace

std::string key_of(const redesign::HandleFeature& feature) {
  if (feature.unit.empty()) return feature.name;
  std::string unit = feature.unit;
  if (const std::size_t slash = unit.find('/'); slash != std::string::npos) {
    unit.replace(slash, 1, "_per_");
  }
  return feature.name + "_" + unit;
}

std::string handle_toml(const redesign::HandleShape& shape, const std::string& product) {
  std::string text =
      "# A handle by its features: change the numbers and make it anew with\n"
      "# palmar redesign shape PRODUCT --features THIS --out FOLDER\n";
  text += fmt::format("version = {}\nproduct = {}  # for information\n\n[features]\n",
                      kHandleFileVersion, formats::toml_string(product));
  for (const redesign::HandleFeature& one : redesign::handle_features()) {
    text += fmt::format("{} = {}  # {}\n", key_of(one),
                        rounded(one.scale * shape.features.*one.value), one.meaning);
  }
  const geometry::Rigid3& frame = shape.body.product_from_handle;
  text += fmt::format(
      "\n[ends]\nend_radius_mm = {}\nkept_mm = [{}, {}]  # at the bottom, the top\n",
      rounded(shape.end_radius), rounded(shape.kept_ends[0]), rounded(shape.kept_ends[1]));
  std::string boxes;
  for (const Box3& box : shape.kept_boxes) {
    for (const double one : corners_of(box)) boxes += (boxes.empty() ? "" : ", ") + rounded(one);
  }
  text += "kept_boxes_mm = [" + boxes + "]\n";
  std::string faces;
  for (const std::string& one : shape.kept_faces) {
    faces += (faces.empty() ? "" : ", ") + formats::toml_string(one);
  }
  text += "kept_faces = [" + faces + "]\n";
  text += fmt::format("\n[frame]  # for information\norigin_mm = {}\nalong = {}\npalm = {}\n",
                      vector_text(frame.translation), vector_text(frame.rotation * Vec3::UnitZ()),
                      vector_text(frame.rotation * Vec3::UnitY()));
  return text;
}

HandleFile read_handle(const std::filesystem::path& path) {
  const toml::table table =
      formats::parse_toml(formats::read_file(path, kMostHandleBytes), path.string());
  const formats::TomlSection file(path.string(), "", table);
  file.allow({"version", "product", "features", "ends", "frame"});
  if (!file.integer("version", 1, kHandleFileVersion)) {
    file.fail("version", fmt::format("version is needed; {} is allowed", kHandleFileVersion));
  }
  const auto features = file.table("features");
  if (!features)
    file.fail("features", "features is needed: a table with the features of the handle");
  std::vector<std::string> keys;
  for (const redesign::HandleFeature& one : redesign::handle_features())
    keys.push_back(key_of(one));
  features->allow(keys);
  HandleFile result;
  for (const redesign::HandleFeature& one : redesign::handle_features()) {
    const std::string key = key_of(one);
    const bool is_needed = one.name == "width" || one.name == "depth";
    const double value =
        is_needed ? features->need_number(key, one.unit, one.lowest, one.highest)
                  : features->number(key, one.unit, one.lowest, one.highest).value_or(0.0);
    result.features.*one.value = value / one.scale;
  }
  if (const auto ends = file.table("ends")) {
    ends->allow({"end_radius_mm", "kept_mm", "kept_boxes_mm", "kept_faces"});
    result.end_radius = ends->number("end_radius_mm", "mm", 0.0, kMostEnd).value_or(0.0);
    if (ends->has("kept_mm") && ends->values()["kept_mm"].is_array()) {
      const std::vector<double> both = ends->numbers("kept_mm", "mm", 0.0, kMostEnd);
      if (both.size() != 2) {
        ends->fail("kept_mm", fmt::format("kept_mm has {} lengths; one for the bottom and one for "
                                          "the top are required",
                                          both.size()));
      }
      result.kept_ends = {both[0], both[1]};
    } else {
      const double both = ends->number("kept_mm", "mm", 0.0, kMostEnd).value_or(0.0);
      result.kept_ends = {both, both};
    }
    result.kept_faces = ends->texts("kept_faces");
    const std::vector<double> corners = ends->numbers("kept_boxes_mm", "mm", -kFar, kFar);
    if (corners.size() % 6 != 0) {
      ends->fail("kept_boxes_mm",
                 fmt::format("kept_boxes_mm has {} coordinates; six for each box are required",
                             corners.size()));
    }
    for (std::size_t i = 0; i < corners.size(); i += 6) {
      result.kept_boxes.push_back(box_of_corners(std::span(corners).subspan(i, 6)));
    }
  }
  return result;
}

}  // namespace palmar::records
