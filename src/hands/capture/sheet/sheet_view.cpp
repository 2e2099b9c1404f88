// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/sheet/sheet_view.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "hands/capture/photo/photo_view.h"
#include "hands/capture/picture_vectors.h"
#include "hands/capture/sheet/picture_edges.h"
#include "hands/imaging/connected_parts.h"
#include "hands/imaging/otsu.h"
#include "palmar/core/error.h"
#include "palmar/geometry/convex_hull.h"
#include "palmar/geometry/degrees.h"
#include "palmar/statistics/median.h"

namespace palmar::capture {
namespace {

constexpr int kSmallSide = 700;       // pixels: of the picture in which the sheet is looked for
constexpr double kLeastShare = 0.06;  // of the picture that the sheet fills
constexpr double kUsualFocal = 0.74;  // of the longer side: 26 mm on film, as most telephones have
constexpr double kLeastEdge = 0.3;    // of an edge that must be seen
constexpr const char* kSheetAdvice =
    "place the hand on a white sheet of A4 on a darker table, all of the sheet in the picture";

/// Pixels that are as bright and as grey as paper in this light.
imaging::VoxelMask paper_of(const geometry::RgbImage& image) {
  const std::size_t count = image.rgb.size() / 3;
  std::vector<double> heap(256, 0.0);
  const auto darkest = [&](std::size_t p) {
    return std::min({image.rgb[3 * p], image.rgb[3 * p + 1], image.rgb[3 * p + 2]});
  };
  for (std::size_t p = 0; p < count; ++p) heap[darkest(p)] += 1.0;
  // The colour of paper: the middle one of the brightest twentieth.
  double above = 0.0;
  int bright = 255;
  while (bright > 0 && above < 0.05 * static_cast<double>(count)) {
    above += heap[bright--];
  }
  std::array<std::vector<std::uint8_t>, 3> channel;
  for (std::size_t p = 0; p < count; ++p) {
    if (darkest(p) <= bright) continue;
    for (std::size_t c = 0; c < 3; ++c) channel[c].push_back(image.rgb[3 * p + c]);
  }
  std::array<double, 3> paper{};
  for (std::size_t c = 0; c < 3; ++c) {
    paper[c] = std::max(1.0, static_cast<double>(statistics::median(std::move(channel[c]))));
  }
  // Grey by that: separated from the table by brightness.
  std::vector<double> share(count, 0.0);
  std::vector<double> brightness(128, 0.0);
  constexpr double kColour = 0.2;
  for (std::size_t p = 0; p < count; ++p) {
    std::array<double, 3> ratio{};
    for (std::size_t c = 0; c < 3; ++c) ratio[c] = image.rgb[3 * p + c] / paper[c];
    const double least = std::min({ratio[0], ratio[1], ratio[2]});
    const double most = std::max({ratio[0], ratio[1], ratio[2]});
    share[p] = most - least < kColour * most ? least : 0.0;
    brightness[static_cast<std::size_t>(std::clamp(least, 0.0, 1.27) * 100.0)] += 1.0;
  }
  const double limit = std::clamp(imaging::otsu_threshold(brightness) / 100.0, 0.35, 0.8);
  imaging::VoxelMask mask(count, 0);
  for (std::size_t p = 0; p < count; ++p) mask[p] = share[p] > limit ? 1 : 0;
  return mask;
}

double grey_at(const geometry::RgbImage& image, const Vec2& pixel) {
  return pixel_colour(image, pixel).minCoeff();
}

/// What a camera of some focal length says of a homography: columns of a rotation would be square
/// to each other and of one length.
struct Columns {
  Vec3 a, b, c;  ///< with the lens' axis at the origin
  Columns(const Eigen::Matrix3d& h, const Vec2& middle) {
    Eigen::Matrix3d m = h;
    m.row(0) -= middle.x() * h.row(2);
    m.row(1) -= middle.y() * h.row(2);
    a = m.col(0);
    b = m.col(1);
    c = m.col(2);
  }
  static double dot(const Vec3& x, const Vec3& y, double f) {
    return (x.x() * y.x() + x.y() * y.y()) / (f * f) + x.z() * y.z();
  }
  /// How far from a rotation, as shares.
  double misfit(double f) const {
    const double aa = dot(a, a, f), bb = dot(b, b, f), ab = dot(a, b, f);
    return std::hypot(ab / std::sqrt(aa * bb), 0.5 * std::log(aa / bb));
  }
};

/// The focal length with which a homography fits a camera best, within what lenses have.
double best_focal(const Columns& columns, double longer_side) {
  double best = kUsualFocal * longer_side, least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= 120; ++i) {
    const double f = longer_side * 0.5 * std::pow(4.0, i / 120.0);
    const double misfit = columns.misfit(f);
    if (misfit < least) {
      least = misfit;
      best = f;
    }
  }
  return best;
}

struct Fit {
  SheetFormat format;
  double focal = 0.0, misfit = 0.0;
  std::string source;
};

/// The focal length that counts for one format: the camera's word; else what the sheet says if it
/// is tilted enough to say something; else the usual one.
Fit fit_of(const Eigen::Matrix3d& h, const SheetFormat& format, const geometry::RgbImage& image,
           const SheetOptions& options) {
  const Vec2 middle(0.5 * (image.width - 1), 0.5 * (image.height - 1));
  const Columns columns(h, middle);
  const double longer = std::max(image.width, image.height);
  if (options.focal) return {format, *options.focal, columns.misfit(*options.focal), "camera"};
  const double usual = kUsualFocal * longer, own = best_focal(columns, longer);
  // How much a fifth more or less would matter.
  const double proportion_misfit = columns.misfit(1.2 * own) + columns.misfit(own / 1.2);
  constexpr double kClear = 0.05;
  if (proportion_misfit > kClear && columns.misfit(own) < 0.02) {
    return {format, own, columns.misfit(own), "sheet"};
  }
  return {format, usual, columns.misfit(usual), "usual"};
}

/// The corner that is farthest from what is seen of the sheet.
Vec2 hidden_corner(const std::vector<Vec2>& hull, const std::array<Vec2, 4>& corner) {
  Vec2 result = corner[0];
  double farthest = -1.0;
  for (const Vec2& c : corner) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vec2& p : hull) nearest = std::min(nearest, (p - c).norm());
    if (nearest <= farthest) continue;
    farthest = nearest;
    result = c;
  }
  return result;
}

[[noreturn]] void fail(const std::string& name, const std::string& what) {
  throw InputError(name + ": " + what);
}

/// Pixels of the small picture at the border of what is taken for the sheet.
struct PaperRim {
  std::vector<Vec2> points;
  int on_border = 0;  ///< of the picture
};

PaperRim rim_of(const imaging::VolumeGrid& grid, const imaging::ConnectedParts& parts,
                const std::vector<char>& is_sheet) {
  PaperRim rim;
  const int width = grid.size[0], height = grid.size[1];
  const auto is_in = [&](int x, int y) {
    const int part = parts.part[grid.at(x, y, 0)];
    return part >= 0 && is_sheet[part] != 0;
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (!is_in(x, y)) continue;
      const bool is_border = x == 0 || y == 0 || x == width - 1 || y == height - 1;
      if (is_border) ++rim.on_border;
      if (is_border || !is_in(x - 1, y) || !is_in(x + 1, y) || !is_in(x, y - 1) ||
          !is_in(x, y + 1)) {
        rim.points.emplace_back(x, y);
      }
    }
  }
  return rim;
}

/// The sheet within that rim, in a picture reduced `by` times to `width`.
SheetView sheet_of(const geometry::RgbImage& image, const PaperRim& rim, int width, int by,
                   const std::string& name, const SheetOptions& options) {
  if (rim.on_border > width / 20) {
    fail(name, fmt::format("what is white reaches the picture's border over {} of {} pixels: the "
                           "sheet isn't all in it, or the table is as white; {}",
                           rim.on_border * by, 2 * (image.width + image.height), kSheetAdvice));
  }
  const std::vector<Vec2> hull = geometry::convex_hull(rim.points);
  const auto quad = hull.size() < 4 ? std::nullopt : four_sided(hull);
  const double hull_area = area_of(hull),
               quad_area = quad ? area_of({quad->begin(), quad->end()}) : 0.0;
  if (!quad) {
    fail(name, fmt::format("the largest white part isn't a sheet with four edges: something white "
                           "is beside it, or it is bent; {}",
                           kSheetAdvice));
  }
  if (std::abs(hull_area) < 0.93 * std::abs(quad_area)) {
    const Vec2 hidden = by * hidden_corner(hull, *quad);
    fail(name, fmt::format("a corner of the sheet isn't seen, at about pixel ({:.0f}, {:.0f}): the "
                           "hand or something else covers it; all four corners must be free; {}",
                           hidden.x(), hidden.y(), kSheetAdvice));
  }
  // Clockwise in the picture, from the upper left corner.
  std::array<Vec2, 4> corner = *quad;
  for (Vec2& c : corner) c = by * c + Vec2::Constant(0.5 * (by - 1));
  if (quad_area < 0.0) std::reverse(corner.begin(), corner.end());
  const auto first = std::min_element(
      corner.begin(), corner.end(), [](const Vec2& a, const Vec2& b) { return a.sum() < b.sum(); });
  std::rotate(corner.begin(), first, corner.end());

  std::array<SeenLine, 4> line;
  for (std::size_t e = 0; e < 4; ++e) {
    const Vec2 &from = corner[e], &to = corner[(e + 1) % 4];
    const std::vector<Vec2> found = edge_points([&](const Vec2& at) { return grey_at(image, at); },
                                                from, to, {.reach = 3.0 * by + 8.0});
    line[e] = line_through(found);
    if (line[e].points < kLeastEdge * kEdgePlaces) {
      fail(name, fmt::format("an edge of the sheet, from pixel ({:.0f}, {:.0f}) to ({:.0f}, "
                             "{:.0f}), is hidden or bent: {} of {} places on it are seen; all but "
                             "the wrist must be within the sheet; {}",
                             from.x(), from.y(), to.x(), to.y(), line[e].points, kEdgePlaces,
                             kSheetAdvice));
    }
  }
  SheetView view;
  double error = 0.0;
  for (std::size_t e = 0; e < 4; ++e) {
    const FittedLine &before = line[(e + 3) % 4].line, &after = line[e].line;
    const auto at = meeting(before.point, before.point + before.direction, after.point,
                            after.point + after.direction);
    if (!at)
      fail(name, std::string("edges of the sheet are parallel that should meet; ") + kSheetAdvice);
    view.corner[e] = *at;
    error += 0.25 * after.error * after.error;
  }

  std::vector<Fit> fits;
  const std::vector<SheetFormat> formats =
      options.format ? std::vector<SheetFormat>{*options.format} : sheet_formats();
  for (const SheetFormat& format : formats) {
    for (const bool lies : {false, true}) {
      SheetFormat one = format;
      if (lies) std::swap(one.width, one.height);
      fits.push_back(
          fit_of(homography_of(view.corner, one.width, one.height), one, image, options));
    }
  }
  std::sort(fits.begin(), fits.end(),
            [](const Fit& a, const Fit& b) { return a.misfit < b.misfit; });
  const Fit& best = fits.front();
  if (best.misfit > 0.06) {
    fail(name,
         fmt::format("the white sheet is no {}: its sides are in another proportion, by {:.0f} "
                     "%; name it with setting \"sheet\", and don't crop the photograph",
                     options.format ? options.format->name : "A4 or letter", 100.0 * best.misfit));
  }
  for (const Fit& other : fits) {
    if (other.format.name != best.format.name && other.misfit < 1.8 * best.misfit + 0.008) {
      fail(name,
           fmt::format("{} and {} fit the sheet as well; say which it is with setting \"sheet\"",
                       best.format.name, other.format.name));
    }
  }
  view.format = best.format;
  view.focal = best.focal;
  view.focal_source = best.source;
  view.pixel_from_sheet = homography_of(view.corner, view.format.width, view.format.height);
  const Columns columns(view.pixel_from_sheet,
                        Vec2(0.5 * (image.width - 1), 0.5 * (image.height - 1)));
  const auto unscaled = [&](const Vec3& v) {
    return Vec3(v.x() / view.focal, v.y() / view.focal, v.z());
  };
  Vec3 r1 = unscaled(columns.a), r2 = unscaled(columns.b), t = unscaled(columns.c);
  const double scale = 2.0 / (r1.norm() + r2.norm());
  r1 *= scale;
  r2 *= scale;
  t *= scale;
  if (t.z() < 0.0) {
    r1 = -r1;
    r2 = -r2;
    t = -t;
  }
  // Square to each other, both giving way alike.
  const Vec3 u = (r1.normalized() + r2.normalized()).normalized();
  const Vec3 v = (r1.normalized() - r2.normalized()).normalized();
  r1 = (u + v).normalized();
  r2 = (u - v).normalized();
  view.eye = -Vec3(r1.dot(t), r2.dot(t), r1.cross(r2).dot(t));
  view.tilt = std::acos(std::clamp(view.eye.z() / view.eye.norm(), -1.0, 1.0)) / geometry::kDegree;
  if (!(view.eye.z() > 0.0) || view.tilt > options.most_tilt) {
    fail(name,
         fmt::format("the photograph is taken {:.0f} degrees off the sheet's normal; up to {:.0f} "
                     "is allowed: hold the camera above the hand",
                     view.tilt, options.most_tilt));
  }
  const double pixel = view.eye.norm() / view.focal;  // mm
  view.edge_error = std::sqrt(error) * pixel;
  view.edge_width = std::numeric_limits<double>::infinity();
  for (std::size_t e = 0; e < 4; ++e) {
    const auto sharpness = edge_width([&](const Vec2& at) { return grey_at(image, at); },
                                      view.corner[e], view.corner[(e + 1) % 4],
                                      {.reach = kSharpnessReach / pixel, .from_corner = 0.1});
    if (sharpness) view.edge_width = std::min(view.edge_width, *sharpness * pixel);
  }
  if (const auto why = blurred(view.edge_width, pixel, "sheet")) fail(name, *why);
  return view;
}

}  // namespace

std::optional<std::string> blurred(double edge_width, double pixel, const std::string& what) {
  const double allowed = std::max(kWidestEdge, kSharpPixels * pixel);
  if (edge_width <= allowed) return {};
  const std::string measured = std::isfinite(edge_width)
                                   ? fmt::format("{:.1f} mm", edge_width)
                                   : fmt::format("more than {:.0f} mm", kSharpnessReach);
  return fmt::format(
      "the photograph is blurred: the sharpest edge of the {} goes from dark to bright over {}; up "
      "to {:.1f} mm is "
      "allowed, as blur makes a hand broader: hold the camera still, let it focus, and have more "
      "light",
      what, measured, allowed);
}

const std::vector<SheetFormat>& sheet_formats() {
  static const std::vector<SheetFormat> all = {{"a4", 210.0, 297.0}, {"letter", 215.9, 279.4}};
  return all;
}

const SheetFormat& card_format() {
  static const SheetFormat card = {"card", 85.60, 53.98, 3.18, 0.76};
  return card;
}

const SheetFormat& sheet_format_named(const std::string& name) {
  for (const SheetFormat& one : sheet_formats()) {
    if (one.name == name) return one;
  }
  if (name == card_format().name) return card_format();
  throw UsageError("sheet \"" + name + "\"; a4, letter and card are allowed");
}

void SheetOptions::check() const {
  if (!(most_tilt > 0.0 && most_tilt < 80.0)) {
    throw UsageError(fmt::format("most_tilt is {} deg; above 0 to 80 is allowed", most_tilt));
  }
  if (focal && !(*focal > 1.0)) {
    throw UsageError(fmt::format("focal length is {} pixels; above 1 is allowed", *focal));
  }
}

Vec2 SheetView::pixel_of(const Vec2& sheet) const {
  return (pixel_from_sheet * sheet.homogeneous()).hnormalized();
}

SheetView find_sheet(const geometry::RgbImage& image, const std::string& name,
                     const SheetOptions& options) {
  options.check();
  const int longer = std::max(image.width, image.height);
  if (std::min(image.width, image.height) < 300) {
    fail(name,
         fmt::format("the picture has {} x {} pixels; at least 300 each way are needed, better "
                     "2000",
                     image.width, image.height));
  }
  const int by = std::max(1, longer / kSmallSide);
  const geometry::RgbImage small = reduced_picture(image, by);
  const imaging::VolumeGrid grid{
      {small.width, small.height, 1}, Vec3::Ones(), Eigen::Matrix3d::Identity(), Vec3::Zero()};
  const imaging::ConnectedParts parts = imaging::connected_parts(grid, paper_of(small));
  const int sheet = parts.largest();
  if (sheet < 0 ||
      static_cast<double>(parts.voxels[sheet]) < kLeastShare * static_cast<double>(grid.count())) {
    fail(name, fmt::format("no white sheet is found; {}", kSheetAdvice));
  }
  std::vector<char> is_sheet(parts.voxels.size(), 0);
  is_sheet[sheet] = 1;
  try {
    return sheet_of(image, rim_of(grid, parts, is_sheet), small.width, by, name, options);
  } catch (const InputError&) {
    // A finger over an edge may part the sheet.
    constexpr double kPiece = 0.015;  // of the largest part
    bool is_cut = false;
    for (std::size_t p = 0; p < is_sheet.size(); ++p) {
      if (is_sheet[p] != 0 || static_cast<double>(parts.voxels[p]) <
                                  kPiece * static_cast<double>(parts.voxels[sheet])) {
        continue;
      }
      is_sheet[p] = 1;
      is_cut = true;
    }
    if (is_cut) {
      try {
        return sheet_of(image, rim_of(grid, parts, is_sheet), small.width, by, name, options);
      } catch (const InputError&) {  // what the largest part lacks is the better message
      }
    }
    throw;
  }
}

}  // namespace palmar::capture
