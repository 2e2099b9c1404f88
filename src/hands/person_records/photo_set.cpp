// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_records/photo_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "palmar/core/error.h"
#include "palmar/core/text.h"
#include "palmar/formats/file.h"
#include "palmar/formats/json_reason.h"
#include "palmar/formats/json_whole.h"

namespace palmar::person_records {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

bool is_photograph(const fs::path& path) {
  const std::string extension = lower_case(path.extension().string());
  return extension == ".png" || extension == ".jpg" || extension == ".jpeg";
}

/// By what names say: whole sets only. A few that don't are an error, as all would be taken for
/// photographs of one camera.
void describe_by_names(const fs::path& folder, PhotoSet& set) {
  static const std::regex kName("(?:^|[^a-z0-9])p([0-9]{1,4})[^a-z0-9]+c([0-9]{1,4})(?:[^0-9]|$)",
                                std::regex::icase);
  std::vector<std::string> silent;
  for (PhotoFile& file : set.photographs) {
    const std::string stem = file.path.stem().string();
    std::smatch match;
    if (!std::regex_search(stem, match, kName)) {
      silent.push_back(file.path.filename().string());
      continue;
    }
    file.position = std::stoi(match[1].str());
    file.camera = "c" + match[2].str();
  }
  const std::size_t count = set.photographs.size();
  set.is_described = silent.empty();
  if (set.is_described) return;
  if (2 * silent.size() < count) {
    throw InputError(
        fmt::format("{}: the names of {} photographs give position and camera (as p3_c2.jpg does), "
                    "that of {} doesn't: rename it, take it away, or describe all in photos.json",
                    folder.string(), count - silent.size(), silent.front()));
  }
  for (std::size_t i = 0; i < count; ++i) {
    PhotoFile& file = set.photographs[i];
    file.camera = file.exif && !file.exif->camera.empty() ? file.exif->camera : "camera";
    file.position = static_cast<int>(i);
  }
}

void read_exif_data(PhotoSet& set) {
  constexpr std::size_t kBeginning = 1 << 17;
  for (PhotoFile& file : set.photographs) {
    file.exif = images::read_exif(formats::read_ends(file.path, kBeginning).head);
  }
}

/// One camera with one zoom takes what is said to be of one.
void check_cameras(const PhotoSet& set) {
  std::map<std::string, const PhotoFile*> first;
  for (const PhotoFile& file : set.photographs) {
    if (!file.exif) continue;
    const PhotoFile& other = *first.try_emplace(file.camera, &file).first->second;
    if (file.exif->camera != other.exif->camera) {
      throw InputError(fmt::format(
          "{} was taken with \"{}\", {} with \"{}\"; they are said to be of one camera (\"{}\")",
          other.path.string(), other.exif->camera, file.path.string(), file.exif->camera,
          file.camera));
    }
    constexpr double kAlike = 0.01;
    if (std::abs(file.exif->focal_mm - other.exif->focal_mm) > kAlike * other.exif->focal_mm) {
      throw InputError(fmt::format(
          "{} was taken at a focal length of {:g} mm, {} of {:g} mm: the zoom of a camera must "
          "stay "
          "as it is, or their names must say that they are of several cameras",
          other.path.string(), other.exif->focal_mm, file.path.string(), file.exif->focal_mm));
    }
  }
}

void read_description(const fs::path& path, const fs::path& folder, PhotoSet& set) {
  const std::string name = path.string();
  try {
    const Json json = Json::parse(formats::read_file(path));
    if (json.contains("board")) {
      const Json& board = json.at("board");
      set.board.squares = board.value("squares", set.board.squares);
      set.board.square = board.value("square_mm", set.board.square);
      set.board.marker = board.value("marker_mm", set.board.marker);
    }
    if (!json.contains("photographs")) return;
    for (const Json& one : json.at("photographs")) {
      PhotoFile file{folder / one.at("file").get<std::string>(),
                     one.value("camera", std::string("camera")),
                     formats::json_whole<int>(one.at("position")),
                     {}};
      if (!fs::is_regular_file(file.path)) {
        throw InputError(name + ": photograph " + file.path.string() + " isn't there");
      }
      set.photographs.push_back(std::move(file));
    }
    set.is_described = !set.photographs.empty();
  } catch (const Json::exception& error) {
    throw InputError(name + ": " + formats::json_reason(error));
  }
  try {
    set.board.check();
  } catch (const UsageError& error) {
    throw InputError(name + ": " + error.what());
  }
}

}  // namespace

PhotoSet read_photo_set(const fs::path& folder) {
  if (!fs::is_directory(folder)) {
    throw InputError(folder.string() + ": a folder of photographs is expected");
  }
  PhotoSet set;
  const fs::path description = folder / "photos.json";
  if (fs::exists(description)) read_description(description, folder, set);
  if (set.photographs.empty()) {
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.is_regular_file() && is_photograph(entry.path())) {
        set.photographs.push_back({entry.path(), "", 0, {}});
      }
    }
    std::sort(set.photographs.begin(), set.photographs.end(),
              [](const PhotoFile& a, const PhotoFile& b) { return a.path < b.path; });
    read_exif_data(set);
    describe_by_names(folder, set);
  } else {
    read_exif_data(set);
  }
  if (set.photographs.empty()) {
    throw InputError(folder.string() + ": no photograph (.png, .jpg, .jpeg) in it");
  }
  std::stable_sort(
      set.photographs.begin(), set.photographs.end(), [](const PhotoFile& a, const PhotoFile& b) {
        return a.position != b.position ? a.position < b.position : a.camera < b.camera;
      });
  check_cameras(set);
  // Positions from 0 without gaps.
  std::set<int> positions;
  for (const PhotoFile& file : set.photographs) positions.insert(file.position);
  for (PhotoFile& file : set.photographs) {
    file.position =
        static_cast<int>(std::distance(positions.begin(), positions.find(file.position)));
  }
  return set;
}

bool holds_photographs(const fs::path& folder) {
  if (fs::exists(folder / "photos.json")) return true;
  const fs::directory_iterator files(folder);
  return std::any_of(begin(files), end(files), [](const fs::directory_entry& entry) {
    return entry.is_regular_file() && is_photograph(entry.path());
  });
}

std::vector<fs::path> paths_of(const PhotoSet& set) {
  std::vector<fs::path> paths;
  for (const PhotoFile& file : set.photographs) paths.push_back(file.path);
  return paths;
}

PhotoLenses read_lenses(const fs::path& path) {
  const std::string name = path.string();
  PhotoLenses lenses;
  try {
    const Json json = Json::parse(formats::read_file(path));
    for (const auto& [camera, one] : json.at("cameras").items()) {
      capture::LensCalibration calibration;
      calibration.lens = {.width = formats::json_whole<int>(one.at("width_px")),
                          .height = formats::json_whole<int>(one.at("height_px")),
                          .focal_x = one.at("focal_x_px").get<double>(),
                          .focal_y = one.at("focal_y_px").get<double>(),
                          .centre_x = one.at("centre_x_px").get<double>(),
                          .centre_y = one.at("centre_y_px").get<double>(),
                          .k1 = one.value("k1", 0.0),
                          .k2 = one.value("k2", 0.0)};
      calibration.rms = one.value("rms_px", 0.0);
      calibration.focal_deviation = one.value("focal_deviation_px", 0.0);
      calibration.centre_deviation = one.value("centre_deviation_px", 0.0);
      calibration.photographs = formats::json_whole_or<int>(one, "photographs", 0);
      calibration.lens.check(name + ": camera " + camera);
      lenses[camera] = std::move(calibration);
    }
  } catch (const Json::exception& error) {
    throw InputError(name + ": " + formats::json_reason(error));
  }
  return lenses;
}

std::string format_lenses(const PhotoLenses& lenses) {
  Json cameras = Json::object();
  for (const auto& [camera, one] : lenses) {
    cameras[camera] = {{"width_px", one.lens.width},
                       {"height_px", one.lens.height},
                       {"focal_x_px", one.lens.focal_x},
                       {"focal_y_px", one.lens.focal_y},
                       {"centre_x_px", one.lens.centre_x},
                       {"centre_y_px", one.lens.centre_y},
                       {"k1", one.lens.k1},
                       {"k2", one.lens.k2},
                       {"rms_px", one.rms},
                       {"focal_deviation_px", one.focal_deviation},
                       {"centre_deviation_px", one.centre_deviation},
                       {"photographs", one.photographs}};
  }
  return Json{{"pixel_origin", "centre of the upper left pixel"}, {"cameras", cameras}}.dump(2) +
         "\n";
}

}  // namespace palmar::person_records
