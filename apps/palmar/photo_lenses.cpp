// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "photo_lenses.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>

#include "palmar/core/error.h"

namespace palmar::cli {

namespace fs = std::filesystem;

PhotoLenses calibrate_lenses(const PhotoSet& set, const std::vector<BoardSighting>& seen,
                             const std::string& what) {
  std::map<std::string, std::vector<std::size_t>> by_camera;
  for (std::size_t i = 0; i < set.photographs.size(); ++i) {
    by_camera[set.photographs[i].camera].push_back(i);
  }
  PhotoLenses lenses;
  for (const auto& [camera, photographs] : by_camera) {
    std::vector<std::vector<BoardCorner>> corners;
    const BoardSighting& first = seen[photographs.front()];
    for (const std::size_t i : photographs) {
      if (seen[i].width != first.width || seen[i].height != first.height) {
        throw InputError(fmt::format(
            "{}: {} x {} pixels; {} has {} x {}: photographs of one camera are alike",
            set.photographs[i].path.string(), seen[i].width, seen[i].height,
            set.photographs[photographs.front()].path.string(), first.width, first.height));
      }
      corners.push_back(seen[i].corners);
    }
    lenses[camera] =
        calibrate_lens(first.width, first.height, corners, what + ": camera " + camera);
  }
  return lenses;
}

std::vector<std::string> loose_lenses(const PhotoLenses& lenses, const std::string& advice) {
  constexpr double kLoose = 3.0;  // pixels
  std::vector<std::string> loose;
  for (const auto& [camera, lens] : lenses) {
    if (lens.centre_deviation <= kLoose && lens.focal_deviation <= kLoose) continue;
    loose.push_back(fmt::format(
        "camera {}: its focal length is known to {:.0f} px and its centre to {:.0f} px only; {}",
        camera, lens.focal_deviation, lens.centre_deviation, advice));
  }
  return loose;
}

PhotoLenses lenses_of(const std::string& path, const Progress& progress) {
  if (!fs::is_directory(path)) return read_lenses(path);
  const PhotoSet set = read_photo_set(path);
  return calibrate_lenses(set, find_boards(set.board, paths_of(set), progress), path);
}

}  // namespace palmar::cli
