// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_records/scan_surfaces_file.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/json_reason.h"
#include "palmar/formats/json_whole.h"
#include "palmar/formats/mesh/ply.h"
#include "palmar/records/json_values.h"

namespace palmar::person_records {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kVersion = 1;
constexpr const char* kIndex = "scan.json";

/// Each bone's file: its name, or its number for one without; a second one of a name gets it, too.
std::vector<std::string> files_of(const std::vector<capture::ScannedBone>& bones) {
  std::vector<std::string> files;
  for (std::size_t b = 0; b < bones.size(); ++b) {
    std::string file = bones[b].name.empty() ? fmt::format("bone-{}", b + 1) : bones[b].name;
    for (std::size_t c = 0; c < b; ++c) {
      if (!bones[b].name.empty() && bones[c].name == bones[b].name) {
        file = fmt::format("{}-{}", bones[b].name, b + 1);
      }
    }
    files.push_back("bones/" + file + ".ply");
  }
  return files;
}

Json parsed_index(const fs::path& path) {
  try {
    return Json::parse(formats::read_file(path));
  } catch (const Json::exception& error) {
    throw InputError(path.string() + ": is no JSON: " + formats::json_reason(error));
  }
}

geometry::TriangleMesh mesh_at(const fs::path& path) {
  return formats::parse_ply(formats::read_file(path), path.string()).mesh;
}

Vec3 vector_in(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

}  // namespace

void write_scan_surfaces(const std::string& folder, const capture::ScanSurfaces& surfaces,
                         const std::string& key) {
  const fs::path base(folder);
  formats::create_folder(base);
  std::error_code ignored;
  fs::remove(base / kIndex, ignored);
  fs::remove_all(base / "bones", ignored);  // another run's names
  formats::create_folder(base / "bones");
  formats::write_file(base / "skin.ply", formats::format_ply(surfaces.skin));
  const std::vector<std::string> files = files_of(surfaces.bones);
  Json bones = Json::array();
  for (std::size_t b = 0; b < files.size(); ++b) {
    const capture::ScannedBone& bone = surfaces.bones[b];
    formats::write_file(base / files[b], formats::format_ply(bone.mesh));
    bones.push_back({{"name", bone.name}, {"file", files[b]}, {"is_cut", bone.is_cut}});
  }
  Json markers = Json::array();
  for (const Vec3& marker : surfaces.markers) markers.push_back(records::vector3(marker));
  const Json index = {{"palmar_scan_version", kVersion},
                      {"key", key},
                      {"side", std::string(name_of(surfaces.side))},
                      {"air_threshold", surfaces.air_threshold},
                      {"bone_threshold", surfaces.bone_threshold},
                      {"noise", surfaces.noise},
                      {"voxel_mm", records::vector3(surfaces.voxel)},
                      {"bone_error_estimate_mm", surfaces.bone_error_estimate},
                      {"fat_shift_mm", records::vector3(surfaces.fat_shift)},
                      {"skin", "skin.ply"},
                      {"bones", bones},
                      {"markers_mm", markers},
                      {"notes", surfaces.notes}};
  formats::write_file(base / kIndex, index.dump(1) + "\n");
}

std::string key_of_scan_surfaces(const std::string& folder) {
  const fs::path path = fs::path(folder) / kIndex;
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return "";
  try {
    return parsed_index(path).value("key", "");
  } catch (const Error&) {
    return "";
  }
}

capture::ScanSurfaces read_scan_surfaces(const std::string& folder) {
  const fs::path base(folder), path = base / kIndex;
  const Json json = parsed_index(path);
  try {
    const int version = formats::json_whole<int>(json.at("palmar_scan_version"));
    if (version > kVersion) {
      throw InputError(fmt::format("{}: is of version {}; this program reads up to {}",
                                   path.string(), version, kVersion));
    }
    capture::ScanSurfaces surfaces;
    const std::string side = json.at("side").get<std::string>();
    if (side != name_of(hand::Side::kLeft) && side != name_of(hand::Side::kRight)) {
      throw InputError(path.string() + ": side is \"" + side + "\"; left and right are allowed");
    }
    surfaces.side = side == name_of(hand::Side::kLeft) ? hand::Side::kLeft : hand::Side::kRight;
    surfaces.air_threshold = json.at("air_threshold").get<double>();
    surfaces.bone_threshold = json.at("bone_threshold").get<double>();
    surfaces.noise = json.at("noise").get<double>();
    if (json.contains("voxel_mm")) surfaces.voxel = vector_in(json.at("voxel_mm"));
    surfaces.bone_error_estimate = json.at("bone_error_estimate_mm").get<double>();
    if (json.contains("fat_shift_mm")) surfaces.fat_shift = vector_in(json.at("fat_shift_mm"));
    surfaces.skin = mesh_at(base / json.at("skin").get<std::string>());
    for (const Json& bone : json.at("bones")) {
      surfaces.bones.push_back({bone.at("name").get<std::string>(),
                                mesh_at(base / bone.at("file").get<std::string>()),
                                bone.at("is_cut").get<bool>()});
    }
    for (const Json& marker : json.at("markers_mm")) surfaces.markers.push_back(vector_in(marker));
    surfaces.notes = json.at("notes").get<std::vector<std::string>>();
    return surfaces;
  } catch (const Json::exception& error) {
    throw InputError(path.string() + ": isn't as Palmar writes it: " + formats::json_reason(error));
  }
}

}  // namespace palmar::person_records
