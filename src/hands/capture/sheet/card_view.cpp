// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/sheet/card_view.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "hands/capture/photo/photo_view.h"
#include "hands/capture/picture_vectors.h"
#include "hands/capture/sheet/card_pose.h"
#include "hands/capture/sheet/picture_edges.h"
#include "hands/capture/sheet/sheet_grid.h"
#include "hands/imaging/connected_parts.h"
#include "palmar/core/error.h"
#include "palmar/geometry/convex_hull.h"
#include "palmar/geometry/degrees.h"

namespace palmar::capture {
namespace {

constexpr int kSmallCardSide = 900;      // pixels: of the picture in which the card is looked for
constexpr double kLeastCard = 0.004;     // of the picture
constexpr double kLeastHandPart = 0.02;  // likewise
constexpr float kOtherColour = 0.15F;    // share by which a channel differs from grey
constexpr float kBrighter = 1.45F, kDarker = 0.2F;  // over the table's light; shadows: 0.3 to 0.8
constexpr double kCardEdge = 0.6;                   // of an edge that must be seen
constexpr const char* kCardAdvice =
    "place the hand on a plain table that isn't of the colour of skin, and the card beside it, not "
    "under it, all of it in the picture, in another colour than the table";

[[noreturn]] void fail_card(const std::string& name, const std::string& what) {
  throw InputError(name + ": " + what);
}

/// What isn't table in a picture, and the table's light.
struct OffTable {
  imaging::VolumeGrid grid;
  imaging::ConnectedParts parts;
  std::vector<Vec3f> table;  ///< linear
};

OffTable off_table(const geometry::RgbImage& small) {
  RectifiedSheet drawn;
  drawn.grid.width = small.width;
  drawn.grid.height = small.height;
  drawn.light.resize(drawn.grid.count());
  drawn.is_seen.assign(drawn.grid.count(), 1);
  for (std::size_t p = 0; p < drawn.light.size(); ++p) {
    for (int c = 0; c < 3; ++c) {
      drawn.light[p][c] = linear_light(small.rgb[3 * p + static_cast<std::size_t>(c)]);
    }
  }
  OffTable result;
  result.table = level_light(drawn, Ground::kTable);
  result.grid = {
      {small.width, small.height, 1}, Vec3::Ones(), Eigen::Matrix3d::Identity(), Vec3::Zero()};
  imaging::VoxelMask mask(drawn.light.size(), 0);
  for (std::size_t p = 0; p < mask.size(); ++p) {
    const Vec3f& light = drawn.light[p];
    const float mean = std::max(0.01F, light.mean());
    const float colour = (light / mean - Vec3f::Ones()).cwiseAbs().maxCoeff();
    mask[p] = colour > kOtherColour || mean > kBrighter || mean < kDarker ? 1 : 0;
  }
  result.parts = imaging::connected_parts(result.grid, imaging::opened(result.grid, mask, 1.5));
  return result;
}

/// One part of what isn't table.
struct Part {
  int number = 0;
  double area = 0.0;  ///< pixels of the small picture
  Vec2 middle = Vec2::Zero();
  /// What touches the picture's borders: left, right, upper, lower.
  std::array<Vec2, 4> on_border{Vec2::Zero(), Vec2::Zero(), Vec2::Zero(), Vec2::Zero()};
  std::array<int, 4> border_pixels{};
  std::vector<Vec2> rim;
};

/// From the hand's middle towards the forearm: to where most of it leaves the picture; if it
/// doesn't, along its longest axis to the end that fills its convex hull best (fingers have gaps
/// between them).
Vec2 towards_forearm(const Part& hand, const OffTable& off) {
  const auto most = std::max_element(hand.border_pixels.begin(), hand.border_pixels.end()) -
                    hand.border_pixels.begin();
  if (hand.border_pixels[most] > 0) {
    return hand.on_border[most] / hand.border_pixels[most] - hand.middle;
  }
  Vec2 axis = Vec2::Zero();
  std::vector<Vec2> inside;
  for (int y = 0; y < off.grid.size[1]; ++y) {
    for (int x = 0; x < off.grid.size[0]; ++x) {
      if (off.parts.part[off.grid.at(x, y, 0)] == hand.number) inside.emplace_back(x, y);
    }
  }
  axis = fit_line(inside).direction;
  const auto filled = [&](double sign) {
    std::vector<Vec2> rim;
    double area = 0.0;
    const auto is_there = [&](const Vec2& p) { return sign * (p - hand.middle).dot(axis) > 0.0; };
    for (const Vec2& p : inside) area += is_there(p) ? 1.0 : 0.0;
    for (const Vec2& p : hand.rim) {
      if (is_there(p)) rim.push_back(p);
    }
    return area / std::max(1.0, area_of(geometry::convex_hull(rim)));
  };
  return filled(1.0) > filled(-1.0) ? axis : Vec2(-axis);
}

std::vector<Part> parts_of(const OffTable& off) {
  const int width = off.grid.size[0], height = off.grid.size[1];
  std::vector<Part> parts(off.parts.count());
  const double least = kLeastCard * static_cast<double>(off.grid.count());
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int number = off.parts.part[off.grid.at(x, y, 0)];
      if (number < 0) continue;
      Part& part = parts[number];
      part.number = number;
      part.area += 1.0;
      part.middle += Vec2(x, y);
      const std::array<bool, 4> at_border = {x < 2, x >= width - 2, y < 2, y >= height - 2};
      bool is_border = false;
      for (std::size_t b = 0; b < 4; ++b) {
        if (!at_border[b]) continue;
        is_border = true;
        ++part.border_pixels[b];
        part.on_border[b] += Vec2(x, y);
      }
      const auto differs = [&](int u, int v) {
        return off.parts.part[off.grid.at(u, v, 0)] != number;
      };
      if (is_border || differs(x - 1, y) || differs(x + 1, y) || differs(x, y - 1) ||
          differs(x, y + 1)) {
        part.rim.emplace_back(x, y);
      }
    }
  }
  std::vector<Part> large;
  for (Part& part : parts) {
    if (part.area < least) continue;
    part.middle /= part.area;
    large.push_back(std::move(part));
  }
  std::stable_sort(large.begin(), large.end(),
                   [](const Part& a, const Part& b) { return a.area > b.area; });
  return large;
}

/// Four corners of a part that has straight edges, clockwise in the picture from any; else nothing.
std::optional<std::array<Vec2, 4>> corners_of(const Part& part) {
  if (*std::max_element(part.border_pixels.begin(), part.border_pixels.end()) > 0) return {};
  const std::vector<Vec2> hull = geometry::convex_hull(part.rim);
  if (hull.size() < 4) return {};
  const auto quad = four_sided(hull);
  if (!quad) return {};
  const double quad_area = std::abs(area_of({quad->begin(), quad->end()}));
  if (area_of(hull) < 0.94 * quad_area || part.area < 0.55 * quad_area) return {};
  std::array<Vec2, 4> corner = *quad;
  if (area_of({corner.begin(), corner.end()}) < 0.0) std::reverse(corner.begin(), corner.end());
  // Sides in a card's proportion as far as a slant view leaves it.
  const double one = (corner[1] - corner[0]).norm() + (corner[3] - corner[2]).norm(),
               other = (corner[2] - corner[1]).norm() + (corner[0] - corner[3]).norm();
  const double ratio = std::max(one, other) / std::max(1.0, std::min(one, other));
  const double card = card_format().width / card_format().height;
  if (ratio < card / 1.25 || ratio > card * 1.25) return {};
  return corner;
}

/// The card's four edges in the whole picture.
struct CardEdges {
  std::array<FittedLine, 4> line;
  double width = std::numeric_limits<double>::infinity();  ///< of the sharpest, mm (edge_width())
};

CardEdges edges_of(const geometry::RgbImage& image, const std::array<Vec2, 4>& corner,
                   const OffTable& off, int by, const std::string& name) {
  const int width = off.grid.size[0], height = off.grid.size[1];
  const auto differs = [&](const Vec2& at) {
    const Vec3f colour = pixel_colour(image, at);
    const int x = std::clamp(static_cast<int>(at.x() / by), 0, width - 1),
              y = std::clamp(static_cast<int>(at.y() / by), 0, height - 1);
    const Vec3f& table = off.table[off.grid.at(x, y, 0)];
    Vec3f light;
    for (int c = 0; c < 3; ++c) light[c] = linear_light(colour[c]);
    return 255.0 * static_cast<double>((light - table).norm());
  };
  CardEdges edges;
  const double pixel = std::sqrt(card_format().width * card_format().height /
                                 std::abs(area_of({corner.begin(), corner.end()})));  // mm
  for (std::size_t e = 0; e < 4; ++e) {
    const Vec2 &from = corner[e], &to = corner[(e + 1) % 4];
    const Vec2 inwards = Vec2(from.y() - to.y(), to.x() - from.x()).normalized();
    std::vector<double> inside;
    for (int k = 0; k < 60; ++k) {
      inside.push_back(differs(from + (0.1 + 0.8 * k / 59.0) * (to - from) + 8.0 * inwards));
    }
    std::nth_element(inside.begin(), inside.begin() + 30, inside.end());
    const double rise = std::max(4.0, 0.35 * inside[30]);
    const SeenLine line = line_through(edge_points(
        differs, from, to, {.reach = 3.0 * by + 8.0, .rise = rise, .from_corner = 0.1}));
    const auto sharpness = edge_width(
        differs, from, to, {.reach = kSharpnessReach / pixel, .rise = rise, .from_corner = 0.15});
    if (sharpness) edges.width = std::min(edges.width, *sharpness * pixel);
    if (line.points < kCardEdge * kEdgePlaces) {
      fail_card(name, fmt::format("an edge of the card, from pixel ({:.0f}, {:.0f}) to ({:.0f}, "
                                  "{:.0f}), isn't seen well: {} of {} places on it; {}",
                                  from.x(), from.y(), to.x(), to.y(), line.points, kEdgePlaces,
                                  kCardAdvice));
    }
    edges.line[e] = line.line;
  }
  return edges;
}

}  // namespace

SheetView find_card(const geometry::RgbImage& image, const std::string& name,
                    const SheetOptions& options) {
  options.check();
  const int longer = std::max(image.width, image.height);
  if (std::min(image.width, image.height) < 600) {
    fail_card(name, fmt::format("the picture has {} x {} pixels; beside a card at least 600 each "
                                "way are needed, better 3000",
                                image.width, image.height));
  }
  const int by = std::max(1, longer / kSmallCardSide);
  const OffTable off = off_table(reduced_picture(image, by));
  const std::vector<Part> parts = parts_of(off);
  const Part* card = nullptr;
  std::array<Vec2, 4> corner{};
  for (const Part& part : parts) {
    const auto found = corners_of(part);
    if (!found) continue;
    if (card != nullptr) {
      fail_card(name, fmt::format("several things look like a card, at pixels ({:.0f}, {:.0f}) and "
                                  "({:.0f}, {:.0f}); only one may be there",
                                  by * card->middle.x(), by * card->middle.y(),
                                  by * part.middle.x(), by * part.middle.y()));
    }
    card = &part;
    corner = *found;
  }
  if (card == nullptr) {
    fail_card(name,
              fmt::format("no bank card is found that is wholly seen: {} parts of the picture "
                          "aren't table, none with four free edges in a card's proportion; {}",
                          parts.size(), kCardAdvice));
  }
  const auto hand = std::find_if(parts.begin(), parts.end(), [&](const Part& part) {
    return &part != card && part.area > kLeastHandPart * static_cast<double>(off.grid.count());
  });
  if (hand == parts.end()) {
    fail_card(name, fmt::format("no hand is found beside the card; {}", kCardAdvice));
  }
  const auto whole = [&](const Vec2& p) { return Vec2(by * p + Vec2::Constant(0.5 * (by - 1))); };
  for (Vec2& c : corner) c = whole(c);
  const auto [lines, width] = edges_of(image, corner, off, by, name);
  for (std::size_t e = 0; e < 4; ++e) {
    const FittedLine &before = lines[(e + 3) % 4], &after = lines[e];
    const auto at = meeting(before.point, before.point + before.direction, after.point,
                            after.point + after.direction);
    if (!at) fail_card(name, "edges of the card are parallel that should meet");
    corner[e] = *at;
  }
  constexpr double kUsualFocal = 0.74;  // of the longer side: 26 mm on film, as telephones have
  const double focal = options.focal ? *options.focal : kUsualFocal * longer;
  const CardPose pose =
      fit_card(corner, lines, focal, Vec2(0.5 * (image.width - 1), 0.5 * (image.height - 1)));
  const double size = std::sqrt(std::abs(area_of({corner.begin(), corner.end()})));
  if (pose.misfit > 0.02 * size) {
    fail_card(name,
              fmt::format("what looks like a card isn't one: its edges miss those of a card of "
                          "85.60 x 53.98 mm by {:.1f} pixels; is it partly covered? {}",
                          pose.misfit, kCardAdvice));
  }
  // Its lower edge is the one that faces the forearm.
  SheetView view;
  const Eigen::Matrix3d sheet_from_pixel = pose.pixel_from_table().inverse();
  const auto on_table = [&](const Vec2& p) {
    return Vec2((sheet_from_pixel * whole(p).homogeneous()).hnormalized());
  };
  const Vec2 towards =
      (on_table(hand->middle + towards_forearm(*hand, off)) - on_table(hand->middle)).normalized();
  const double angle = std::atan2(towards.y(), towards.x());
  const double quarter = 0.5 * std::numbers::pi;
  const int turns = static_cast<int>(std::lround((angle + quarter) / quarter));
  const double skew = angle + quarter - turns * quarter;
  if (std::abs(skew) > 30.0 * geometry::kDegree) {
    fail_card(
        name,
        fmt::format(
            "the card isn't parallel to the forearm, by {:.0f} degrees; place one of its edges "
            "level with the crease of the wrist, perpendicular to the forearm, within 30 degrees",
            std::abs(skew) / geometry::kDegree));
  }
  const CardPose turned = pose.turned(turns);
  view.format = card_format();
  view.format.width = turned.width;
  view.format.height = turned.height;
  view.focal = focal;
  view.focal_source = options.focal ? "camera" : "usual";
  view.pixel_from_sheet = turned.pixel_from_table();
  view.eye = turned.eye();
  // Of the way it looks: the card lies to one side.
  const Vec3 normal = turned.camera_from_table.rotation * Vec3::UnitZ();
  view.tilt = std::acos(std::clamp(-normal.z(), -1.0, 1.0)) / geometry::kDegree;
  if (!(view.eye.z() > 0.0) || view.tilt > options.most_tilt) {
    fail_card(name, fmt::format("the photograph is taken {:.0f} degrees off the table's normal; up "
                                "to {:.0f} is allowed: hold the camera above the hand",
                                view.tilt, options.most_tilt));
  }
  if (const auto why = blurred(width, view.eye.norm() / focal, "card")) fail_card(name, *why);
  view.edge_width = width;
  view.corner = corner;
  view.edge_error = pose.misfit * view.eye.norm() / focal;
  const Eigen::Matrix3d turned_from_pixel = view.pixel_from_sheet.inverse();
  const Vec2 middle = (turned_from_pixel * whole(hand->middle).homogeneous()).hnormalized();
  view.scale_error = turned.scale_error(Vec2(middle.x(), -0.5 * turned.height),
                                        Vec2(middle.x(), -0.5 * turned.height + 185.0));
  return view;
}

}  // namespace palmar::capture
