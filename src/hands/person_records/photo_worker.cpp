// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_records/photo_worker.h"

#include <nlohmann/json.hpp>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/formats/file.h"
#include "palmar/formats/json_reason.h"
#include "palmar/formats/process/program_missing.h"
#include "palmar/formats/process/worker.h"

namespace palmar::person_records {
namespace {

using Json = nlohmann::ordered_json;

Json run_photo(const std::string& verb, Json request, const formats::WorkerFolder& folder,
               const std::string& object, const Progress& progress) {
  static const formats::Worker kPhoto = {
      .program = "palmar-photo",
      .variable = "PALMAR_PHOTO",
      .name = "the photograph program",
      .crashed = "the photograph program crashed on it",
      .reason = "it is damaged, or holds what OpenCV can't handle"};
  if (!std::filesystem::exists(formats::program_of(kPhoto))) {
    throw formats::ProgramMissing(
        formats::program_of(kPhoto).string() +
        " isn't there: Palmar was built without OpenCV (libopencv-contrib-dev), "
        "which boards in photographs are found with");
  }
  request["threads"] = thread_count();
  constexpr double kSeconds = 3600.0, kMegabytes = 8192.0;
  const std::string reply = formats::run_worker(
      kPhoto, verb, request.dump(), folder, object,
      {.seconds = kSeconds, .memory_mb = kMegabytes, .is_fixed = true}, progress);
  return Json::parse(reply);
}

/// What can't be used of an answer is reported as such.
template <typename Take>
auto taken(const Take& take) {
  try {
    return take();
  } catch (const Json::exception& error) {
    throw InputError(std::string("the photograph program's answer is damaged: ") +
                     formats::json_reason(error));
  }
}

Json json_of(const capture::BoardPattern& pattern) {
  return {
      {"squares", pattern.squares}, {"square_mm", pattern.square}, {"marker_mm", pattern.marker}};
}

}  // namespace

capture::BoardPicture draw_board(const capture::BoardPattern& pattern, int pixels_per_square) {
  pattern.check();
  const formats::WorkerFolder folder;
  return taken([&] {
    const Json reply = run_photo(
        "board", {{"pattern", json_of(pattern)}, {"pixels_per_square", pixels_per_square}}, folder,
        "the board", {});
    capture::BoardPicture picture;
    picture.pixels = reply.at("pixels").get<int>();
    const std::string bytes = formats::read_file(folder.path() / "board.bin");
    picture.grey.assign(bytes.begin(), bytes.end());
    if (picture.pixels < 1 ||
        picture.grey.size() != static_cast<std::size_t>(picture.pixels) * picture.pixels) {
      throw InputError("the photograph program's board is damaged");
    }
    return picture;
  });
}

std::vector<BoardSighting> find_boards(const capture::BoardPattern& pattern,
                                       const std::vector<std::filesystem::path>& files,
                                       const Progress& progress) {
  pattern.check();
  Json names = Json::array();
  for (const auto& file : files) names.push_back(std::filesystem::absolute(file).string());
  const formats::WorkerFolder folder;
  return taken([&] {
    const Json reply = run_photo("corners", {{"pattern", json_of(pattern)}, {"files", names}},
                                 folder, "photographs", progress);
    std::vector<BoardSighting> sightings;
    for (const Json& one : reply.at("photographs")) {
      BoardSighting sighting;
      sighting.width = one.at("width").get<int>();
      sighting.height = one.at("height").get<int>();
      sighting.sharpness = one.at("sharpness").get<double>();
      for (const Json& c : one.at("corners")) {
        sighting.corners.push_back({c.at(0).get<int>(),
                                    Vec3(c.at(3).get<double>(), c.at(4).get<double>(), 0.0),
                                    {c.at(1).get<double>(), c.at(2).get<double>()}});
      }
      sightings.push_back(std::move(sighting));
    }
    if (sightings.size() != files.size()) {
      throw InputError("the photograph program's answer is about another number of photographs");
    }
    return sightings;
  });
}

capture::PointMatches match_points(const std::vector<MatchPicture>& pictures,
                                   const std::vector<std::array<int, 2>>& pairs,
                                   const Progress& progress) {
  const formats::WorkerFolder folder;
  std::string bytes;
  Json sizes = Json::array();
  for (const MatchPicture& picture : pictures) {
    sizes.push_back({{"width", picture.width}, {"height", picture.height}});
    bytes.append(picture.grey.begin(), picture.grey.end());
    bytes.append(picture.inside.begin(), picture.inside.end());
  }
  formats::write_file(folder.path() / "pictures.bin", bytes);
  return taken([&] {
    const Json reply = run_photo("match", {{"pictures", sizes}, {"pairs", pairs}}, folder,
                                 "photographs", progress);
    capture::PointMatches matches;
    matches.point = reply.at("points").get<std::vector<std::vector<std::array<float, 2>>>>();
    matches.pair = pairs;
    matches.match = reply.at("pairs").get<std::vector<std::vector<std::array<int, 2>>>>();
    bool is_good = matches.point.size() == pictures.size() && matches.match.size() == pairs.size();
    for (std::size_t n = 0; is_good && n < pairs.size(); ++n) {
      for (const auto& match : matches.match[n]) {
        for (std::size_t side = 0; side < 2; ++side) {
          const auto& points = matches.point[pairs[n][side]];
          is_good =
              is_good && match[side] >= 0 && static_cast<std::size_t>(match[side]) < points.size();
        }
      }
    }
    if (!is_good) throw InputError("the photograph program's matches are damaged");
    return matches;
  });
}

}  // namespace palmar::person_records
