// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/photo/hand_outline.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/imaging/connected_parts.h"
#include "palmar/photo/photo_view.h"

namespace palmar {
namespace {

using Vec2 = Eigen::Vector2d;
using Vec3f = Eigen::Vector3f;

constexpr double kBorder = 1.5;  // mm: of the sheet that isn't looked at, for its edge is blurred
constexpr double kWidestGap = 6.0;  // mm, of the forearm on the edge: folds, hair
constexpr double kLeastForearm = 25.0, kMostForearm = 110.0;  // mm
constexpr double kProminence = 12.0;                          // mm: of a fingertip over its webs
constexpr double kAboveWeb = 1.5;                          // mm; as HandCreases draws base creases
constexpr double kIndexSlope = 0.12, kLittleSlope = 0.35;  // of base creases, likewise
constexpr double kWebToHead = 17.0 / 185.0;  // webs lie 14 to 20 mm beyond the metacarpals' heads
                                             // in a hand of 185 mm (Bugbee & Botte 1993)

[[noreturn]] void fail(const std::string& name, const std::string& what) {
  throw InputError(name + ": " + what);
}

float linear(double srgb) {
  const double c = srgb / 255.0;
  return static_cast<float>(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
}

/// The sheet drawn in its own frame: light of cells, square, from the upper left.
struct SheetGrid {
  int width = 0, height = 0;
  double cell = 1.0;
  Vec2 corner = Vec2::Zero();  ///< centre of the first cell
  std::vector<Vec3f> light;    ///< linear; over that of paper once level() is done

  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
  Vec2 sheet(double x, double y) const { return corner + cell * Vec2(x, -y); }
  Vec2 place(const Vec2& p) const {
    return {(p.x() - corner.x()) / cell, (corner.y() - p.y()) / cell};
  }
  VolumeGrid volume() const {
    return {{width, height, 1}, Vec3(cell, cell, cell), Eigen::Matrix3d::Identity(), Vec3::Zero()};
  }
};

SheetGrid drawn(const RgbImage& image, const SheetView& sheet, double cell) {
  SheetGrid grid;
  grid.cell = cell;
  grid.width = static_cast<int>((sheet.format.width - 2.0 * kBorder) / cell);
  grid.height = static_cast<int>((sheet.format.height - 2.0 * kBorder) / cell);
  grid.corner = 0.5 * cell * Vec2(-(grid.width - 1), grid.height - 1);
  grid.light.resize(static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height));
  std::array<float, 256> table{};
  for (std::size_t i = 0; i < 256; ++i) table[i] = linear(static_cast<double>(i));
  parallel_for(grid.height, [&](int y) {
    for (int x = 0; x < grid.width; ++x) {
      Vec3f sum = Vec3f::Zero();
      constexpr int kSide = 3;
      for (int v = 0; v < kSide; ++v) {
        for (int u = 0; u < kSide; ++u) {
          const Vec2 pixel =
              sheet.pixel_of(grid.sheet(x + (u + 0.5) / kSide - 0.5, y + (v + 0.5) / kSide - 0.5));
          const Vec3f colour = pixel_colour(image, pixel);
          for (int c = 0; c < 3; ++c) {
            sum[c] += table[static_cast<std::size_t>(std::clamp(colour[c] + 0.5F, 0.0F, 255.0F))];
          }
        }
      }
      grid.light[grid.at(x, y)] = sum / (kSide * kSide);
    }
  });
  return grid;
}

/// Divides by the light of the paper: a quadratic of the place for each channel, fitted to what is
/// nearly as bright as it.
void level(SheetGrid& grid) {
  using Six = Eigen::Matrix<double, 6, 1>;
  const auto terms = [&](int x, int y) {
    const double u = 2.0 * x / grid.width - 1.0, v = 2.0 * y / grid.height - 1.0;
    Six t;
    t << 1.0, u, v, u * u, u * v, v * v;
    return t;
  };
  std::vector<float> brightness;
  for (std::size_t p = 0; p < grid.light.size(); p += 7) brightness.push_back(grid.light[p].sum());
  const auto high = brightness.begin() + static_cast<std::ptrdiff_t>(brightness.size() * 85 / 100);
  std::nth_element(brightness.begin(), high, brightness.end());
  Eigen::Matrix<double, 6, 3> paper = Eigen::Matrix<double, 6, 3>::Zero();
  paper.row(0).setConstant(*high / 3.0);
  constexpr double kNear = 0.82;  // of the paper's light; shadows are darker
  for (int round = 0; round < 4; ++round) {
    Eigen::MatrixXd normal = 1e-6 * Eigen::MatrixXd::Identity(6, 6);
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(6, 3);
    const double near = round == 0 ? 0.6 : kNear;
    for (int y = 0; y < grid.height; y += 4) {
      for (int x = 0; x < grid.width; x += 4) {
        const Six t = terms(x, y);
        const Eigen::Vector3d light = grid.light[grid.at(x, y)].cast<double>();
        const Eigen::Vector3d ratio = light.cwiseQuotient((paper.transpose() * t).cwiseMax(1e-4));
        if (ratio.minCoeff() < near || ratio.maxCoeff() > 1.25) continue;
        normal += t * t.transpose();
        right += t * light.transpose();
      }
    }
    paper = Eigen::LDLT<Eigen::MatrixXd>(normal).solve(right);
  }
  parallel_for(grid.height, [&](int y) {
    for (int x = 0; x < grid.width; ++x) {
      const Eigen::Vector3d light = (paper.transpose() * terms(x, y)).cwiseMax(1e-3);
      Vec3f& here = grid.light[grid.at(x, y)];
      here = here.cwiseQuotient(light.cast<float>());
    }
  });
}

/// How red: shadows on the paper are as grey as it is.
float redness(const Vec3f& light) { return (light[0] - light[2]) / std::max(0.02F, light.sum()); }

/// Cells of skin: redder than half way from the paper to skin, the largest part, holes filled.
VoxelMask skin_of(const SheetGrid& grid, const std::string& name) {
  constexpr double kLow = -0.1, kHigh = 0.7;
  constexpr int kBins = 160;
  std::vector<double> heap(kBins, 0.0);
  for (const Vec3f& light : grid.light) {
    const double t = (redness(light) - kLow) / (kHigh - kLow);
    heap[static_cast<std::size_t>(std::clamp(t, 0.0, 0.999) * kBins)] += 1.0;
  }
  double all = 0.0, sum = 0.0;
  for (int i = 0; i < kBins; ++i) {
    all += heap[static_cast<std::size_t>(i)];
    sum += i * heap[static_cast<std::size_t>(i)];
  }
  double low = 0.0, low_sum = 0.0, best = -1.0;
  int split = 0;
  for (int i = 0; i + 1 < kBins; ++i) {
    low += heap[static_cast<std::size_t>(i)];
    low_sum += i * heap[static_cast<std::size_t>(i)];
    if (low <= 0.0 || low >= all) continue;
    const double between =
        low * (all - low) * std::pow(low_sum / low - (sum - low_sum) / (all - low), 2);
    if (between > best) {
      best = between;
      split = i;
    }
  }
  const double parting = kLow + (split + 1) * (kHigh - kLow) / kBins;
  std::array<std::vector<float>, 3> channel;
  double paper = 0.0, papers = 0.0;
  for (const Vec3f& light : grid.light) {
    const double r = redness(light);
    if (r > parting) {
      for (std::size_t c = 0; c < 3; ++c) channel[c].push_back(light[static_cast<int>(c)]);
    } else {
      paper += r;
      papers += 1.0;
    }
  }
  Vec3f skin = Vec3f::Zero();
  for (std::size_t c = 0; c < 3; ++c) {
    if (channel[c].empty()) break;
    const auto middle = channel[c].begin() + static_cast<std::ptrdiff_t>(channel[c].size() / 2);
    std::nth_element(channel[c].begin(), middle, channel[c].end());
    skin[static_cast<int>(c)] = *middle;
  }
  paper = papers > 0.0 ? paper / papers : 0.0;
  const double area = static_cast<double>(channel[0].size()) * grid.cell * grid.cell;
  if (redness(skin) - paper < 0.05 || area < 3000.0) {
    fail(name,
         fmt::format("no hand is found on the sheet: what isn't paper covers {:.0f} cm2 and is "
                     "no redder than it ({:.3f}; 0.05 is needed)",
                     area / 100.0, redness(skin) - paper));
  }
  // Where half of a cell is skin; dark skin reddens a half cell little, so no less than a third.
  const double half = redness(0.5F * (skin + Vec3f::Ones()));
  const double limit = paper + std::max(half, 0.33 * (redness(skin) - paper));
  VoxelMask mask(grid.light.size(), 0);
  for (std::size_t p = 0; p < mask.size(); ++p) {
    mask[p] = redness(grid.light[p]) > limit ? 1 : 0;
  }
  const VolumeGrid volume = grid.volume();
  mask = opened(volume, mask, 0.8);
  const ConnectedParts parts = connected_parts(volume, mask);
  if (parts.count() == 0) fail(name, "no hand is found on the sheet");
  mask = mask_of(parts, parts.largest());
  VoxelMask outside(mask.size());
  for (std::size_t p = 0; p < mask.size(); ++p) outside[p] = mask[p] == 0 ? 1 : 0;
  const ConnectedParts holes = connected_parts(volume, outside);
  std::vector<char> is_open(static_cast<std::size_t>(holes.count()), 0);
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      if (x > 0 && y > 0 && x + 1 < grid.width && y + 1 < grid.height) continue;
      const int hole = holes.part[grid.at(x, y)];
      if (hole >= 0) is_open[static_cast<std::size_t>(hole)] = 1;
    }
  }
  // A gap between fingers that touch at their tips is no hole of the skin: up to 1 cm2 (nails,
  // rings, blemishes) is.
  for (std::size_t p = 0; p < mask.size(); ++p) {
    const int hole = holes.part[p];
    if (hole < 0 || is_open[static_cast<std::size_t>(hole)] != 0) continue;
    const double hole_area =
        static_cast<double>(holes.voxels[static_cast<std::size_t>(hole)]) * grid.cell * grid.cell;
    if (hole_area > 100.0) {
      fail(name,
           fmt::format("the hand's outline encloses {:.1f} cm2 of paper: fingers touch; spread "
                       "them so that paper shows between all of them",
                       hole_area / 100.0));
    }
    mask[p] = 1;
  }
  return mask;
}

/// The outline of a mask as corners of cells, closed, the mask to its left (in a frame with y up).
std::vector<Vec2> outline_of(const SheetGrid& grid, const VoxelMask& mask) {
  const auto is_in = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < grid.width && y < grid.height && mask[grid.at(x, y)] != 0;
  };
  int sx = 0, sy = 0;
  for (std::size_t p = 0; p < mask.size(); ++p) {
    if (mask[p] != 0) {
      sx = static_cast<int>(p % static_cast<std::size_t>(grid.width));
      sy = static_cast<int>(p / static_cast<std::size_t>(grid.width));
      break;
    }
  }
  // Along the cracks between cells; directions: right, down, left, up (rows go down). Beginning on
  // the upper edge of the first cell, leftwards: the mask lies to the left.
  static constexpr std::array<std::array<int, 2>, 4> kStep = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  int x = sx + 1, y = sy, direction = 2;
  std::vector<Vec2> corners;
  const int x0 = x, y0 = y;
  do {
    corners.push_back(grid.sheet(x - 0.5, y - 0.5));
    x += kStep[static_cast<std::size_t>(direction)][0];
    y += kStep[static_cast<std::size_t>(direction)][1];
    // Cells before the corner, to the left and to the right of the way.
    const auto cell = [&](bool left) {
      switch (direction) {
        case 0:
          return is_in(x, left ? y - 1 : y);
        case 1:
          return is_in(left ? x : x - 1, y);
        case 2:
          return is_in(x - 1, left ? y : y - 1);
        default:
          return is_in(left ? x - 1 : x, y - 1);
      }
    };
    if (!cell(true)) {
      direction = (direction + 3) % 4;  // left, round the mask's corner
    } else if (cell(false)) {
      direction = (direction + 1) % 4;  // right
    }
  } while (x != x0 || y != y0 || direction != 2);
  return corners;
}

/// Smoothed by a bell of `sigma` mm along the curve; ends stay.
std::vector<Vec2> smoothed(const std::vector<Vec2>& curve, double sigma, double step) {
  const int reach = static_cast<int>(std::ceil(3.0 * sigma / step));
  const int n = static_cast<int>(curve.size());
  std::vector<Vec2> result(curve.size());
  for (int i = 0; i < n; ++i) {
    Vec2 sum = Vec2::Zero();
    double whole = 0.0;
    for (int j = -reach; j <= reach; ++j) {
      const double w = std::exp(-0.5 * std::pow(j * step / sigma, 2));
      sum += w * curve[static_cast<std::size_t>(std::clamp(i + j, 0, n - 1))];
      whole += w;
    }
    result[static_cast<std::size_t>(i)] = sum / whole;
  }
  return result;
}

/// The part of the outline that isn't the sheet's edge, from one side of the forearm to the other.
struct OpenOutline {
  std::vector<Vec2> curve;
  Vec2 from = Vec2::Zero(), to = Vec2::Zero();  ///< where it leaves the edge and comes back to it
};

OpenOutline open_outline(const SheetGrid& grid, const SheetView& sheet,
                         const std::vector<Vec2>& closed, const std::string& name) {
  const double right = 0.5 * grid.width * grid.cell - 0.6 * grid.cell,
               up = 0.5 * grid.height * grid.cell - 0.6 * grid.cell;
  const auto on_edge = [&](const Vec2& p) {
    return std::abs(p.x()) > right || std::abs(p.y()) > up;
  };
  const std::size_t n = closed.size();
  // Stretches on the edge, those with small gaps between them taken together.
  struct Run {
    std::size_t first, count;
  };
  std::vector<Run> runs;
  std::size_t start = 0;
  while (start < n && on_edge(closed[start])) ++start;
  const auto gap = static_cast<std::size_t>(kWidestGap / grid.cell);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t p = (start + i) % n;
    if (!on_edge(closed[p])) continue;
    if (!runs.empty() && i - (runs.back().first + runs.back().count) <= gap) {
      runs.back().count = i + 1 - runs.back().first;
    } else {
      runs.push_back({i, 1});
    }
  }
  if (runs.empty()) {
    fail(name,
         "the hand ends within the sheet: the forearm must cross an edge of the sheet, bare, "
         "with the crease of the wrist at the edge (a sleeve or a bracelet hides it)");
  }
  const Run forearm = *std::max_element(
      runs.begin(), runs.end(), [](const Run& a, const Run& b) { return a.count < b.count; });
  OpenOutline result;
  result.from = closed[(start + forearm.first + forearm.count - 1) % n];
  result.to = closed[(start + forearm.first) % n];
  const Vec2 across = result.to - result.from;
  if (std::min(std::abs(across.x()), std::abs(across.y())) > 6.0) {
    fail(name, "the forearm crosses a corner of the sheet; it must cross one edge");
  }
  if (across.norm() < kLeastForearm || across.norm() > kMostForearm) {
    fail(name,
         fmt::format("what crosses the sheet's edge is {:.0f} mm wide; the wrist, {:.0f} to {:.0f} "
                     "mm, is to lie there",
                     across.norm(), kLeastForearm, kMostForearm));
  }
  for (const Run& run : runs) {
    if (run.first == forearm.first || run.count * grid.cell < 2.0) continue;
    const Vec2 at = closed[(start + run.first + run.count / 2) % n];
    fail(name,
         fmt::format("the hand reaches beyond the sheet at ({:.0f}, {:.0f}) mm from its middle, "
                     "{} x {} mm: all but the wrist must lie on it",
                     at.x(), at.y(), sheet.format.width, sheet.format.height));
  }
  for (std::size_t i = forearm.first + forearm.count; i < forearm.first + n; ++i) {
    result.curve.push_back(closed[(start + i) % n]);
  }
  result.curve = smoothed(result.curve, 0.7, grid.cell);
  return result;
}

struct Extreme {
  std::size_t at = 0;
  double height = 0.0;
};

/// Tips and the webs between them: maxima of a curve's distance from a point that stand out by
/// kProminence, and the minima between them.
struct Fingers {
  std::vector<Extreme> tips, webs;
};

Fingers fingers_of(const std::vector<Vec2>& curve, const Vec2& middle) {
  Fingers result;
  Extreme high{0, 0.0}, low{0, std::numeric_limits<double>::infinity()};
  bool rising = true;
  // The curve begins at the wrist: as if from a height of its own.
  low.height = (curve.front() - middle).norm();
  high = {0, low.height};
  rising = false;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const double d = (curve[i] - middle).norm();
    if (rising) {
      if (d > high.height) high = {i, d};
      if (d < high.height - kProminence) {
        result.tips.push_back(high);
        low = {i, d};
        rising = false;
      }
    } else {
      if (d < low.height) low = {i, d};
      if (d > low.height + kProminence) {
        if (!result.tips.empty()) result.webs.push_back(low);
        high = {i, d};
        rising = true;
      }
    }
  }
  // What rises at the end is the forearm.
  if (!result.webs.empty() && result.webs.size() >= result.tips.size()) result.webs.pop_back();
  return result;
}

/// A mask that is soft at its border, between cells.
class SoftMask {
 public:
  SoftMask(const SheetGrid& grid, const VoxelMask& mask) : grid_(grid), value_(mask.size()) {
    parallel_for(grid.height, [&](int y) {
      for (int x = 0; x < grid.width; ++x) {
        float sum = 0.0F;
        for (int v = -1; v <= 1; ++v) {
          for (int u = -1; u <= 1; ++u) {
            sum += mask[grid.at(std::clamp(x + u, 0, grid.width - 1),
                                std::clamp(y + v, 0, grid.height - 1))];
          }
        }
        value_[grid.at(x, y)] = sum / 9.0F;
      }
    });
  }
  double operator()(const Vec2& sheet) const {
    const Vec2 p = grid_.place(sheet);
    const int x = static_cast<int>(std::floor(p.x())), y = static_cast<int>(std::floor(p.y()));
    if (x < 0 || y < 0 || x + 1 >= grid_.width || y + 1 >= grid_.height) return 0.0;
    const double u = p.x() - x, v = p.y() - y;
    return (1 - v) * ((1 - u) * value_[grid_.at(x, y)] + u * value_[grid_.at(x + 1, y)]) +
           v * ((1 - u) * value_[grid_.at(x, y + 1)] + u * value_[grid_.at(x + 1, y + 1)]);
  }
  /// How far one can go from a point inside until the border.
  double reach(const Vec2& from, const Vec2& direction, double most) const {
    constexpr double kStep = 0.1;  // mm
    double before = (*this)(from);
    for (double s = kStep; s < most; s += kStep) {
      const double here = (*this)(from + s * direction);
      if (here < 0.5) return before > here ? s - kStep * (0.5 - here) / (before - here) : s;
      before = here;
    }
    return most;
  }

 private:
  const SheetGrid& grid_;
  std::vector<float> value_;
};

/// A finger's middle line.
struct Axis {
  Vec2 point = Vec2::Zero(), direction = Vec2::UnitY();  ///< towards the tip
};

/// Through the middles of cross-sections between 15 and 75 % of the way from the tip to the base.
Axis axis_of(const SoftMask& skin, const Vec2& tip, const Vec2& base) {
  Axis axis{base, (tip - base).normalized()};
  for (int round = 0; round < 4; ++round) {
    const Vec2 across(-axis.direction.y(), axis.direction.x());
    const double length = (tip - base).dot(axis.direction);
    std::vector<Vec2> middles;
    Vec2 mean = Vec2::Zero();
    for (int k = 0; k < 13; ++k) {
      const double from_tip = (0.15 + 0.05 * k) * length;
      const Vec2 c =
          axis.point + ((tip - axis.point).dot(axis.direction) - from_tip) * axis.direction;
      const double left = skin.reach(c, across, 18.0), right = skin.reach(c, -across, 18.0);
      middles.push_back(c + 0.5 * (left - right) * across);
      mean += middles.back() / 13.0;
    }
    double xx = 0.0, xy = 0.0, yy = 0.0;
    for (const Vec2& m : middles) {
      const Vec2 q = m - mean;
      xx += q.x() * q.x();
      xy += q.x() * q.y();
      yy += q.y() * q.y();
    }
    const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
    Vec2 direction(std::cos(angle), std::sin(angle));
    if (direction.dot(axis.direction) < 0.0) direction = -direction;
    axis = {mean, direction};
  }
  return axis;
}

/// The contour's farthest point along a direction near a tip.
Vec2 farthest(const std::vector<Vec2>& curve, std::size_t near, const Vec2& direction,
              double cell) {
  const auto reach = static_cast<std::size_t>(15.0 / cell);
  const std::size_t from = near > reach ? near - reach : 0;
  Vec2 best = curve[near];
  for (std::size_t i = from; i < std::min(curve.size(), near + reach); ++i) {
    if (curve[i].dot(direction) > best.dot(direction)) best = curve[i];
  }
  return best;
}

}  // namespace

void HandOutlineOptions::check() const {
  if (!(cell >= 0.1 && cell <= 1.0)) {
    throw UsageError(fmt::format("cell is {} mm; 0.1 to 1 is allowed", cell));
  }
  if (!(wrist >= 0.0 && wrist <= 80.0)) {
    throw UsageError(
        fmt::format("the wrist crease lies {} mm inside the edge; 0 to 80 is allowed", wrist));
  }
}

HandOutline measure_outline(const RgbImage& image, const SheetView& sheet,
                            const OutlineProportions& proportions, const std::string& name,
                            const HandOutlineOptions& options) {
  options.check();
  SheetGrid grid = drawn(image, sheet, options.cell);
  level(grid);
  const VoxelMask mask = skin_of(grid, name);
  const OpenOutline open = open_outline(grid, sheet, outline_of(grid, mask), name);

  // The palm's middle: the centre of the largest circle in the outline.
  VoxelMask outside(mask.size());
  for (std::size_t p = 0; p < mask.size(); ++p) outside[p] = mask[p] == 0 ? 1 : 0;
  const std::vector<float> depth = distance_transform(grid.volume(), outside);
  // Not where the forearm meets the edge: nothing is outside of the sheet.
  const Vec2 forearm = 0.5 * (open.from + open.to);
  Vec2 middle = forearm;
  double deepest = 0.0;
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      const Vec2 here = grid.sheet(x, y);
      const double d = std::min<double>(depth[grid.at(x, y)],
                                        std::min(0.5 * sheet.format.width - std::abs(here.x()),
                                                 0.5 * sheet.format.height - std::abs(here.y())));
      if (mask[grid.at(x, y)] != 0 && d > deepest) {
        deepest = d;
        middle = here;
      }
    }
  }
  const Vec2 up = (middle - forearm).normalized();
  Fingers fingers = fingers_of(open.curve, middle);
  if (fingers.tips.size() != 5 || fingers.webs.size() != 4) {
    fail(name,
         fmt::format("{} fingertips and {} webs between them are seen in the outline; 5 and 4 "
                     "are needed: spread all fingers and the thumb so that paper shows "
                     "between them down to the webs, no ring or sleeve on the sheet",
                     fingers.tips.size(), fingers.webs.size()));
  }
  HandOutline result;
  std::vector<Vec2> curve = open.curve;
  const auto high = [&](const Extreme& e) { return curve[e.at].dot(up); };
  if (high(fingers.webs.front()) > high(fingers.webs.back())) {
    // The thumb's web is the one nearest to the wrist: the thumb first.
    std::reverse(curve.begin(), curve.end());
    std::reverse(fingers.tips.begin(), fingers.tips.end());
    std::reverse(fingers.webs.begin(), fingers.webs.end());
    for (auto* const list : {&fingers.tips, &fingers.webs}) {
      for (Extreme& e : *list) e.at = curve.size() - 1 - e.at;
    }
  }
  const Vec2 thumb_side = curve[fingers.tips.front().at] - middle;
  const bool thumb_left = up.x() * thumb_side.y() - up.y() * thumb_side.x() > 0.0;
  result.is_right = thumb_left != options.palm_up;
  result.contour = curve;

  // From above, at the height that each place has.
  const double length0 = (curve[fingers.tips[2].at] - forearm).norm();
  const auto raised = [&](const Vec2& p, double share) { return sheet.raised(p, share * length0); };
  const double web_height = proportions.web_height, palm_height = proportions.palm_height;
  for (std::size_t k = 0; k < 4; ++k) {
    result.web[k] = raised(curve[fingers.webs[k].at], web_height);
  }
  const SoftMask skin(grid, mask);
  const auto size = [&](double share) { return 1.0 - share * length0 / sheet.eye.z(); };
  std::array<Axis, 5> axis;
  std::array<double, 5> foot{};  // where the base crease crosses the axis, along it, as seen
  for (std::size_t f = 0; f < 5; ++f) {
    OutlineFinger& finger = result.finger[f];
    const Vec2 seen_tip = curve[fingers.tips[f].at];
    const auto seen_web = [&](std::size_t k) { return curve[fingers.webs[k].at]; };
    Vec2 base;
    if (f == 0) {
      base = seen_web(0);
    } else if (f == 1 || f == 4) {
      const Vec2 web = seen_web(f == 1 ? 1 : 3);
      const Vec2 towards = (seen_tip - web).normalized();
      Vec2 aside(-towards.y(), towards.x());
      if (aside.dot(web - seen_web(2)) < 0.0) aside = -aside;
      base = web + 8.0 * aside;
    } else {
      base = 0.5 * (seen_web(f - 1) + seen_web(f));
    }
    if (f == 0) {
      // The thumb's middle line: its last phalanx and a little more.
      const double last = proportions.segment[0][1] * length0;
      const Vec2 towards = (seen_tip - base).normalized();
      axis[0] = axis_of(skin, seen_tip, seen_tip - 1.3 * last * towards);
    } else {
      axis[f] = axis_of(skin, seen_tip, base);
    }
    const Vec2 direction = axis[f].direction, across(-direction.y(), direction.x());
    const auto along = [&](const Vec2& p) { return (p - axis[f].point).dot(direction); };
    const auto aside = [&](const Vec2& p) { return std::abs((p - axis[f].point).dot(across)); };
    const Vec2 tip = farthest(curve, fingers.tips[f].at, direction, grid.cell);
    finger.tip = raised(tip, proportions.finger_height[f]);
    const auto width_at = [&](double at) {
      const Vec2 c = axis[f].point + at * direction;
      return skin.reach(c, across, 25.0) + skin.reach(c, -across, 25.0);
    };
    const double tip_at = along(tip);
    if (f == 0) {
      const double distal = proportions.segment[0][1] * length0,
                   proximal = proportions.segment[0][0] * length0;
      finger.base = raised(axis[0].point + (tip_at - distal - proximal) * direction, web_height);
      continue;  // lies on its side: how wide it is isn't seen
    }
    if (f == 1 || f == 4) {
      const Vec2 web = seen_web(f == 1 ? 1 : 3);
      foot[f] = along(web) + kAboveWeb - (f == 1 ? kIndexSlope : kLittleSlope) * aside(web);
    } else {
      const Vec2 a = seen_web(f - 1), b = seen_web(f);
      const double share = aside(a) / std::max(1e-9, aside(a) + aside(b));
      foot[f] = (1.0 - share) * along(a) + share * along(b) + kAboveWeb;
    }
    finger.base = raised(axis[f].point + foot[f] * direction, web_height);
    finger.length = (finger.tip - finger.base).norm();
    const double seen = tip_at - foot[f];
    double done = 0.0;
    for (std::size_t s = 0; s < 3; ++s) {
      const double share = proportions.segment[f][s];
      const double at = foot[f] + (done + 0.5 * share) * seen;
      const double height = web_height + (proportions.finger_height[f] - web_height) *
                                             std::min(1.0, done + 0.5 * share);
      finger.width[s] = width_at(at) * size(height);
      done += share;
    }
  }
  // The wrist: at the edge, or so far inside of it, where the hand lies on the paper.
  result.wrist = forearm + options.wrist * up;
  const double to_edge = std::min(0.5 * sheet.format.width - std::abs(forearm.x()),
                                  0.5 * sheet.format.height - std::abs(forearm.y()));
  result.wrist -= to_edge * up;
  result.hand_length = (result.finger[2].tip - result.wrist).norm();

  // Over the heads of metacarpals II and V.
  const auto head = [&](std::size_t f) {
    return Vec2(axis[f].point + (foot[f] - kAboveWeb - kWebToHead * length0) * axis[f].direction);
  };
  const Vec2 head2 = head(1), head5 = head(4), across = (head2 - head5).normalized();
  const double between = (head2 - head5).norm();
  const double beyond2 = skin.reach(head2, across, 0.6 * between),
               beyond5 = skin.reach(head5, -across, 0.6 * between);
  if (beyond2 < 0.45 * between && beyond5 < 0.45 * between) {
    result.hand_width = (between + beyond2 + beyond5) * size(palm_height);
  }
  return result;
}

}  // namespace palmar
