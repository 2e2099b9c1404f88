// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// palmar-photo VERB FOLDER: does what FOLDER/request.json asks for with OpenCV and leaves
// FOLDER/reply.json, or FOLDER/error.json and Palmar's exit code. Started by Palmar
// (hands/person_records/photo_worker.h), not by people.
//
// board: {pattern, pixels_per_square} -> board.bin, {pixels}
// corners: {pattern, files, threads} -> {offset_px, photographs: [{width, height, sharpness,
//   corners: [[id, x, y, x_mm, y_mm], ...]}]}
// match: {pictures: [{width, height}], pairs: [[i, j], ...], threads}, pictures.bin (grey, then
//   inside, picture by picture) -> {points: [[[x, y], ...], ...], pairs: [[[i, j], ...], ...]}
#include <unistd.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <map>
#include <new>
#include <string>

#include "../worker/worker_main.h"
#include "hands/board/charuco.h"
#include "hands/board/picture_matches.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/texture_file.h"
#include "palmar/formats/process/worker.h"

namespace {

namespace fs = std::filesystem;
using palmar::Progress;
using palmar::worker::Json;

palmar::capture::BoardPattern pattern_of(const Json& request) {
  const Json& pattern = request.at("pattern");
  return {.squares = pattern.at("squares").get<int>(),
          .square = pattern.at("square_mm").get<double>(),
          .marker = pattern.at("marker_mm").get<double>()};
}

std::vector<std::uint8_t> grey_of(const palmar::geometry::RgbImage& image) {
  std::vector<std::uint8_t> grey(image.rgb.size() / 3);
  for (std::size_t p = 0; p < grey.size(); ++p) {
    // Rec. 601 luma, in 256ths.
    grey[p] = static_cast<std::uint8_t>(
        (77 * image.rgb[3 * p] + 150 * image.rgb[3 * p + 1] + 29 * image.rgb[3 * p + 2]) >> 8);
  }
  return grey;
}

/// How steep the steepest edges are: the 99th percentile of the difference of neighbours along a
/// row, over the range of brightness. 1 for a print without blur.
double sharpness_of(const std::vector<std::uint8_t>& grey, int width) {
  std::vector<int> steps(256, 0), values(256, 0);
  for (std::size_t p = 1; p < grey.size(); ++p) {
    ++values[grey[p]];
    if (p % static_cast<std::size_t>(width) != 0)
      ++steps[static_cast<std::size_t>(std::abs(grey[p] - grey[p - 1]))];
  }
  const auto percentile = [&grey](const std::vector<int>& counts, double share) {
    double sum = 0.0;
    for (std::size_t v = 0; v < counts.size(); ++v) {
      sum += counts[v];
      if (sum >= share * static_cast<double>(grey.size())) return static_cast<double>(v);
    }
    return 255.0;
  };
  return percentile(steps, 0.99) /
         std::max(1.0, percentile(values, 0.98) - percentile(values, 0.02));
}

Json board(const Json& request, const fs::path& folder, const Progress&) {
  const palmar::capture::BoardPicture picture =
      palmar::board::CharucoFinder(pattern_of(request))
          .draw(request.at("pixels_per_square").get<int>());
  palmar::formats::write_file(folder / "board.bin",
                              std::string(picture.grey.begin(), picture.grey.end()));
  return {{"pixels", picture.pixels}};
}

Json corners(const Json& request, const fs::path&, const Progress& progress) {
  const palmar::board::CharucoFinder finder(pattern_of(request));
  const auto files = request.at("files").get<std::vector<std::string>>();
  std::vector<Json> found(files.size());
  std::atomic<int> done{0};
  palmar::parallel_for(static_cast<int>(files.size()), [&](int i) {
    const std::string& file = files[static_cast<std::size_t>(i)];
    const palmar::geometry::RgbImage image =
        palmar::formats::read_texture(palmar::formats::read_file(file), file);
    const std::vector<std::uint8_t> grey = grey_of(image);
    Json list = palmar::worker::Json::array();
    for (const palmar::capture::BoardCorner& corner :
         finder.find(grey, image.width, image.height)) {
      list.push_back(
          {corner.id, corner.pixel.x(), corner.pixel.y(), corner.world.x(), corner.world.y()});
    }
    found[static_cast<std::size_t>(i)] = {{"width", image.width},
                                          {"height", image.height},
                                          {"sharpness", sharpness_of(grey, image.width)},
                                          {"corners", std::move(list)}};
    progress.update(++done / static_cast<double>(files.size()), "looking for the board");
  });
  return {{"offset_px", {finder.offset().x(), finder.offset().y()}}, {"photographs", found}};
}

Json match(const Json& request, const fs::path& folder, const Progress& progress) {
  const std::string bytes = palmar::formats::read_file(folder / "pictures.bin");
  std::vector<palmar::board::MaskedPicture> pictures;
  std::size_t at = 0;
  for (const Json& one : request.at("pictures")) {
    palmar::board::MaskedPicture picture;
    picture.width = one.at("width").get<int>();
    picture.height = one.at("height").get<int>();
    const auto size =
        static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
    if (at + 2 * size > bytes.size()) throw palmar::InputError("pictures.bin: too short");
    picture.grey.assign(bytes.begin() + static_cast<long>(at),
                        bytes.begin() + static_cast<long>(at + size));
    picture.inside.assign(bytes.begin() + static_cast<long>(at + size),
                          bytes.begin() + static_cast<long>(at + 2 * size));
    at += 2 * size;
    pictures.push_back(std::move(picture));
  }
  const auto pairs = request.at("pairs").get<std::vector<std::array<int, 2>>>();
  const palmar::board::PictureMatches matches =
      palmar::board::match_pictures(pictures, pairs, request.value("ratio", 0.85), 3000, progress);
  Json lists = palmar::worker::Json::array();
  for (const auto& pair : matches.pairs) lists.push_back(pair.match);
  return {{"points", matches.point}, {"pairs", std::move(lists)}};
}

}  // namespace

int main(int argc, char** argv) {
  const std::map<std::string, palmar::worker::Verb> verbs = {
      {"board", board}, {"corners", corners}, {"match", match}};
  if (argc != 3 || verbs.count(argv[1]) == 0) {
    std::fprintf(stderr, "palmar-photo is started by palmar-hands; see `palmar photos -h`\n");
    return 2;
  }
  const palmar::worker::Verb& verb = verbs.at(argv[1]);
  return palmar::worker::answer(argv[2],
                                [&](const palmar::worker::Json& request, const fs::path& folder,
                                    const palmar::Progress& progress) {
                                  palmar::set_thread_count(request.value("threads", 0));
                                  return verb(request, folder, progress);
                                });
}
