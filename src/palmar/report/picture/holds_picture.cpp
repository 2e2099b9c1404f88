// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/picture/holds_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "palmar/core/error.h"
#include "palmar/core/progress_part.h"
#include "palmar/hand/skin/skinning.h"
#include "palmar/report/picture/colormap.h"
#include "palmar/report/picture/hold_camera.h"
#include "palmar/report/picture/render.h"
#include "palmar/report/picture/stroke_text.h"
#include "palmar/report/words/phrases.h"

namespace palmar::report {
namespace {

constexpr Rgb kSheetInk{34, 40, 46};
constexpr Rgb kSheetGrey{96, 102, 110};
constexpr Rgb kSheetAmber{158, 96, 0};
constexpr Rgb kSheetLine{214, 218, 222};
constexpr Rgb kHeldGrey{120, 134, 150};  // the part that is held
constexpr Rgb kOtherGrey{184, 191, 198};
constexpr double kTextShare = 0.27;  // of a tile's height, under the picture

struct Tile {
  int left = 0, top = 0, width = 0, height = 0;
};

std::vector<char> triangles_of_part(const product::ProductParts& parts, int number,
                                    std::size_t count) {
  std::vector<char> is_held(count, 0);
  for (std::size_t k = 0; k < std::min(count, parts.part_of_triangle.size()); ++k) {
    const int part = parts.part_of_triangle[k];
    is_held[k] = parts.parts[static_cast<std::size_t>(part)].number == number ? 1 : 0;
  }
  return is_held;
}

/// The product in two greys: the part that is held darker.
Scene scene_of_hold(const HeldScene& held) {
  Scene scene;
  scene.push_back({.mesh = {held.skin, held.hand->skin.triangles}, .colour = kSkinColour});
  SceneObject part{.mesh = {held.product->vertices, {}}, .colour = kHeldGrey};
  SceneObject rest{.mesh = {held.product->vertices, {}}, .colour = kOtherGrey};
  for (std::size_t k = 0; k < held.product->triangles.size(); ++k) {
    (held.is_held_part[k] != 0 ? part : rest).mesh.triangles.push_back(held.product->triangles[k]);
  }
  if (!part.mesh.triangles.empty()) scene.push_back(std::move(part));
  if (!rest.mesh.triangles.empty()) scene.push_back(std::move(rest));
  return scene;
}

void paste(Image& sheet, const Image& picture, int left, int top) {
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) sheet.at(left + x, top + y) = picture.at(x, y);
  }
}

void fill_disc(Image& image, double x, double y, double radius, Rgb colour) {
  for (int j = static_cast<int>(y - radius); j <= static_cast<int>(y + radius); ++j) {
    for (int i = static_cast<int>(x - radius); i <= static_cast<int>(x + radius); ++i) {
      if (i < 0 || j < 0 || i >= image.width || j >= image.height) continue;
      const double gone = std::hypot(i + 0.5 - x, j + 0.5 - y);
      if (gone <= radius) image.at(i, j) = colour;
    }
  }
}

/// What a hold has against it that a designer should know first.
std::string doubt_of(const grasp::RankedHold& hold) {
  return hold.against.empty() ? "" : "against it: " + hold.against;
}

void write_under(Image& sheet, const Tile& tile, int number, const grasp::RankedHold& hold,
                 const Phrases& phrases) {
  const double s = tile.width / 480.0;
  const double x = tile.left + 16 * s, width = tile.width - 32 * s;
  double y = tile.top + tile.height * (1.0 - kTextShare) + 20 * s;
  const auto write = [&](const std::string& text, double cap, Rgb colour, std::size_t lines) {
    for (const std::string& line : wrapped(text, width, cap, lines)) {
      draw_text(sheet, x, y, line, {.cap_height = cap, .colour = colour});
      y += 1.75 * cap;
    }
  };
  write(phrases(hold.words), 11.5 * s, kSheetInk, 2);
  write(phrases(fmt::format("score {:.1f}", hold.score)), 10 * s, kSheetGrey, 1);
  write(phrases(doubt_of(hold)), 10 * s, kSheetAmber, 2);
  const double disc = 19 * s;
  const double cx = tile.left + 16 * s + disc, cy = tile.top + 14 * s + disc;
  fill_disc(sheet, cx, cy, disc, kSheetInk);
  draw_text(sheet, cx, cy + 7.5 * s, std::to_string(number),
            {.cap_height = 15 * s, .colour = kWhite, .align = Align::kCentre, .weight = 0.16});
}

}  // namespace

void HoldsPictureOptions::check() const {
  if (tile_width < 160 || tile_width > 1600) {
    throw UsageError(
        fmt::format("setting \"tile width\" is {} pixels; 160 to 1600 is allowed", tile_width));
  }
  if (columns < 1 || columns > 8) {
    throw UsageError(fmt::format("setting \"columns\" is {}; 1 to 8 is allowed", columns));
  }
  if (most < 1) {
    throw UsageError(fmt::format("setting \"most\" is {}; 1 or more is required", most));
  }
}

std::vector<std::string> wrapped(const std::string& text, double width, double cap_height,
                                 std::size_t most) {
  std::vector<std::string> lines;
  const TextStyle style{.cap_height = cap_height};
  std::string line;
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t end = std::min(text.size(), text.find(' ', at));
    const std::string word = text.substr(at, end - at);
    at = end + 1;
    const std::string longer = line.empty() ? word : line + " " + word;
    if (line.empty() || text_width(longer, style) <= width) {
      line = longer;
      continue;
    }
    if (lines.size() + 1 == most) {
      while (!line.empty() && text_width(line + "...", style) > width) line.pop_back();
      lines.push_back(line + "...");
      return lines;
    }
    lines.push_back(line);
    line = word;
  }
  if (!line.empty() && most > 0) lines.push_back(line);
  return lines;
}

Image holds_picture(const hand::Hand& hand, const product::Product& product,
                    const grasp::RankedHolds& ranked, const HoldsPictureOptions& options,
                    const Progress& progress) {
  options.check();
  const int count =
      static_cast<int>(std::min(ranked.holds.size(), static_cast<std::size_t>(options.most)));
  const int columns = std::max(1, std::min(options.columns, count));
  const int rows = std::max(1, (count + columns - 1) / columns);
  const double s = options.tile_width / 480.0;
  const int head = static_cast<int>(64 * s), side = options.tile_width;
  Image sheet(columns * side, head + rows * side);
  const Phrases phrases(options.language);
  const std::string title = phrases("Ways to hold " + product.name);
  draw_text(sheet, 16 * s, 40 * s, wrapped(title, columns * side - 32 * s, 16 * s, 1).front(),
            {.cap_height = 16 * s, .weight = 0.15});
  if (count == 0) {
    draw_text(sheet, 16 * s, head + 40 * s, phrases("no way of holding it was found"),
              {.cap_height = 12 * s, .colour = kSheetAmber});
    return sheet;
  }
  const Vec3 up = options.up.value_or(Vec3::UnitZ());
  const int picture_height = static_cast<int>(side * (1.0 - kTextShare));
  const double aspect = static_cast<double>(side - 2) / (picture_height - 2);
  for (int k = 0; k < count; ++k) {
    const grasp::RankedHold& hold = ranked.holds[static_cast<std::size_t>(k)];
    const Tile tile{(k % columns) * side, head + (k / columns) * side, side, side};
    HeldScene held;
    held.hand = &hand;
    held.product = &product.mesh;
    held.skin = hand::pose_skin(hand, hold.grasp.posture);
    for (Vec3& p : held.skin) p = hold.grasp.product_from_hand * p;
    held.is_held_part =
        triangles_of_part(ranked.parts, hold.hold.part, product.mesh.triangles.size());
    const Camera camera = camera_of_hold(held, up, aspect);
    const Progress part = part_of(progress, static_cast<double>(k) / count,
                                  static_cast<double>(k + 1) / count, "drawing holds");
    const std::vector<Image> images =
        render_views(scene_of_hold(held), {camera},
                     {.width = side - 2, .height = picture_height - 2, .samples = 2}, part);
    paste(sheet, images.front(), tile.left + 1, tile.top + 1);
    write_under(sheet, tile, k + 1, hold, phrases);
  }
  const int line = std::max(1, static_cast<int>(std::lround(s)));
  for (int r = 0; r < rows; ++r) {
    fill_rectangle(sheet, 0, head + r * side, columns * side, line, kSheetLine);
  }
  for (int c = 1; c < columns; ++c) {
    fill_rectangle(sheet, c * side, head, line, rows * side, kSheetLine);
  }
  return sheet;
}

}  // namespace palmar::report
