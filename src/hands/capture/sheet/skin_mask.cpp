// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/sheet/skin_mask.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "hands/capture/picture_vectors.h"
#include "hands/imaging/connected_parts.h"
#include "hands/imaging/otsu.h"
#include "palmar/core/error.h"
#include "palmar/statistics/median.h"

namespace palmar::capture {
namespace {

constexpr double kLeastRedness = 0.05;  // of skin over paper or table
constexpr double kLeastHand = 3000.0;   // mm2
constexpr float kBluer = -0.06F;        // than paper or table: none of them and no skin

[[noreturn]] void fail_skin(const std::string& name, const std::string& what) {
  throw InputError(name + ": " + what);
}

/// How red: shadows on the paper are as grey as it is.
float redness(const Vec3f& light) { return (light[0] - light[2]) / std::max(0.02F, light.sum()); }

/// Encloses more, or more often, than fingers can: five have four gaps between them.
[[noreturn]] void fail_enclosed(const std::string& name, Ground ground, int gaps, double most) {
  constexpr int kMostGaps = 4;
  constexpr double kLargestGap = 4000.0;  // mm2; between thumb and index 2000 to 3000
  if (ground == Ground::kTable && (gaps > kMostGaps || most > kLargestGap)) {
    fail_skin(name,
              fmt::format("what is redder than the table encloses {} places, up to {:.1f} cm2 "
                          "of it: that is no hand but the table's grain or pattern; place "
                          "hand and card on something plain that isn't of the colour of skin "
                          "or wood, best white, grey or blue",
                          gaps, most / 100.0));
  }
  fail_skin(name, fmt::format("the hand's outline encloses {:.1f} cm2 of {}: fingers touch; spread "
                              "them so that it shows between all of them",
                              most / 100.0, ground == Ground::kPaper ? "paper" : "the table"));
}

/// A hand beside cells that the picture doesn't show goes on there.
void check_in_picture(const RectifiedSheet& sheet, const imaging::VoxelMask& mask,
                      const std::string& name) {
  const SheetGrid& grid = sheet.grid;
  for (int y = 1; y + 1 < grid.height; ++y) {
    for (int x = 2; x + 2 < grid.width; ++x) {
      if (mask[grid.at(x, y)] == 0) continue;
      if (sheet.is_seen[grid.at(x - 2, y)] != 0 && sheet.is_seen[grid.at(x + 2, y)] != 0 &&
          sheet.is_seen[grid.at(x, y - 1)] != 0) {
        continue;
      }
      const Eigen::Vector2d at = grid.sheet(x, y);
      fail_skin(name,
                fmt::format("the picture's border cuts the hand off {:.0f} mm above the wrist; "
                            "all of it must be in the picture",
                            at.y() - grid.sheet(0, grid.height - 0.5).y()));
    }
  }
}

}  // namespace

imaging::VoxelMask skin_mask(const RectifiedSheet& sheet, Ground ground, const std::string& name) {
  const SheetGrid& grid = sheet.grid;
  const std::vector<Vec3f>& lights = sheet.light;
  constexpr double kLow = -0.1, kHigh = 0.7;
  constexpr int kBins = 160;
  std::vector<double> heap(kBins, 0.0);
  for (const Vec3f& light : lights) {
    if (redness(light) < kBluer) continue;  // a card
    const double t = (redness(light) - kLow) / (kHigh - kLow);
    heap[static_cast<std::size_t>(std::clamp(t, 0.0, 0.999) * kBins)] += 1.0;
  }
  const double threshold = kLow + imaging::otsu_threshold(heap) * (kHigh - kLow) / kBins;
  std::array<std::vector<float>, 3> channel;
  double paper = 0.0, papers = 0.0;
  for (const Vec3f& light : lights) {
    const double r = redness(light);
    if (r > threshold) {
      for (std::size_t c = 0; c < 3; ++c) channel[c].push_back(light[static_cast<int>(c)]);
    } else if (r >= kBluer) {
      paper += r;
      papers += 1.0;
    }
  }
  Vec3f skin = Vec3f::Zero();
  for (std::size_t c = 0; c < 3; ++c) {
    if (channel[c].empty()) break;
    skin[static_cast<int>(c)] = statistics::median(channel[c]);
  }
  paper = papers > 0.0 ? paper / papers : 0.0;
  const double area = static_cast<double>(channel[0].size()) * grid.cell * grid.cell;
  const double redder = redness(skin) - paper;
  if (redder < kLeastRedness || area < kLeastHand) {
    fail_skin(
        name,
        ground == Ground::kPaper
            ? fmt::format("no hand is found on the sheet: what isn't paper covers {:.0f} cm2 "
                          "and is no redder than it ({:.3f}; {} is needed)",
                          area / 100.0, redder, kLeastRedness)
            : fmt::format(
                  "no hand is found beside the card: nothing of {:.0f} cm2 or more is redder than "
                  "the table by {} (the reddest: {:.3f}); place hand and card on something that "
                  "isn't of the colour of skin or wood, best white, grey or blue",
                  kLeastHand / 100.0, kLeastRedness, redder));
  }
  // Where half of a cell is skin; dark skin reddens a half cell little, so no less than a third. On
  // a table much darker than skin half a cell is nearly as red as a whole one: there light counts
  // too, as even skin in its own shade is brighter than such a table.
  const double more = redder, half = redness(0.5F * (skin + Vec3f::Ones())) - paper;
  const double limit = paper + std::clamp(half, 0.33 * more, 0.7 * more);
  const Vec3f rise = skin - Vec3f::Ones();
  const bool is_brighter = skin.minCoeff() > 4.0F;
  constexpr float kLit = 0.15F;
  imaging::VoxelMask mask(grid.count(), 0);
  for (std::size_t p = 0; p < mask.size(); ++p) {
    const bool is_lit =
        !is_brighter || (lights[p] - Vec3f::Ones()).dot(rise) > kLit * rise.squaredNorm();
    mask[p] = is_lit && redness(lights[p]) > limit ? 1 : 0;
  }
  const imaging::VolumeGrid volume = grid.volume();
  mask = imaging::opened(volume, mask, 0.8);
  const imaging::ConnectedParts parts = imaging::connected_parts(volume, mask);
  if (parts.count() == 0) fail_skin(name, "no hand is found");
  mask = imaging::mask_of(parts, parts.largest());
  check_in_picture(sheet, mask, name);
  imaging::VoxelMask outside(mask.size());
  for (std::size_t p = 0; p < mask.size(); ++p) outside[p] = mask[p] == 0 ? 1 : 0;
  const imaging::ConnectedParts holes = imaging::connected_parts(volume, outside);
  std::vector<char> is_open(holes.count(), 0);
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      if (x > 0 && y > 0 && x + 1 < grid.width && y + 1 < grid.height) continue;
      const int hole = holes.part[grid.at(x, y)];
      if (hole >= 0) is_open[hole] = 1;
    }
  }
  // A gap between fingers that touch at their tips is no hole of the skin: up to 1 cm2 (nails,
  // rings, blemishes) is.
  constexpr double kLeastGap = 100.0;  // mm2
  int gaps = 0;
  double most = 0.0;
  for (int hole = 0; hole < holes.count(); ++hole) {
    const double hole_area = static_cast<double>(holes.voxels[hole]) * grid.cell * grid.cell;
    if (is_open[hole] != 0 || hole_area <= kLeastGap) continue;
    ++gaps;
    most = std::max(most, hole_area);
  }
  if (gaps > 0) fail_enclosed(name, ground, gaps, most);
  for (std::size_t p = 0; p < mask.size(); ++p) {
    if (holes.part[p] >= 0 && is_open[holes.part[p]] == 0) mask[p] = 1;
  }
  return mask;
}

}  // namespace palmar::capture
