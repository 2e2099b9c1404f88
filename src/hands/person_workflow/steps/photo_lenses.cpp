// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_workflow/steps/photo_lenses.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "palmar/core/error.h"

namespace palmar::person_workflow {

namespace fs = std::filesystem;

namespace {

/// Photographs of one camera have one size; the fewer ones are named.
void check_sizes(const person_records::PhotoSet& set,
                 const std::vector<person_records::BoardSighting>& seen) {
  std::map<std::string, std::map<std::pair<int, int>, std::vector<std::size_t>>> by_size;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    by_size[set.photographs[i].camera][{seen[i].width, seen[i].height}].push_back(i);
  }
  for (const auto& [camera, sizes] : by_size) {
    if (sizes.size() < 2) continue;
    const auto fewer = [](const auto& a, const auto& b) {
      return a.second.size() < b.second.size();
    };
    const auto& [odd, which] = *std::min_element(sizes.begin(), sizes.end(), fewer);
    const auto& [usual, others] = *std::max_element(sizes.begin(), sizes.end(), fewer);
    throw InputError(fmt::format(
        "{}: {} x {} pixels, as {} of camera \"{}\" {}; {} others have {} x {}: photographs of one "
        "camera are alike (names like p3_c2.jpg distinguish the cameras)",
        set.photographs[which.front()].path.string(), odd.first, odd.second, which.size(), camera,
        which.size() == 1 ? "has" : "have", others.size(), usual.first, usual.second));
  }
}

}  // namespace

person_records::PhotoLenses calibrate_lenses(const person_records::PhotoSet& set,
                                             const std::vector<person_records::BoardSighting>& seen,
                                             const std::string& what) {
  std::map<std::string, std::vector<std::size_t>> by_camera;
  for (std::size_t i = 0; i < set.photographs.size(); ++i) {
    by_camera[set.photographs[i].camera].push_back(i);
  }
  check_sizes(set, seen);
  person_records::PhotoLenses lenses;
  for (const auto& [camera, photographs] : by_camera) {
    std::vector<std::vector<capture::BoardCorner>> corners;
    const person_records::BoardSighting& first = seen[photographs.front()];
    for (const std::size_t i : photographs) corners.push_back(seen[i].corners);
    capture::LensExpectation expected;
    const auto& exif = set.photographs[photographs.front()].exif;
    if (exif) expected.focal = exif->focal_pixels(first.width, first.height);
    lenses[camera] = capture::calibrate_lens(first.width, first.height, corners,
                                             what + ": camera " + camera, expected);
  }
  return lenses;
}

std::vector<std::string> loose_lenses(const person_records::PhotoLenses& lenses,
                                      const std::string& advice) {
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

person_records::PhotoLenses lenses_of(const std::string& path, const Progress& progress) {
  if (!fs::is_directory(path)) return person_records::read_lenses(path);
  const person_records::PhotoSet set = person_records::read_photo_set(path);
  return calibrate_lenses(
      set, person_records::find_boards(set.board, person_records::paths_of(set), progress), path);
}

}  // namespace palmar::person_workflow
