// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/sheet/picture_edges.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hands/capture/photo/photo_view.h"
#include "hands/capture/picture_vectors.h"
#include "palmar/statistics/median.h"

namespace palmar::capture {
namespace {

/// Homography from the unit square ((0,0), (1,0), (1,1), (0,1)) to four points (Heckbert 1989).
Eigen::Matrix3d from_unit_square(const std::array<Vec2, 4>& q) {
  const Vec2 d1 = q[1] - q[2], d2 = q[3] - q[2], s = q[0] - q[1] + q[2] - q[3];
  const double det = cross2(d1, d2);
  const double g = cross2(s, d2) / det, h = cross2(d1, s) / det;
  const Vec2 a = q[1] - q[0] + g * q[1], b = q[3] - q[0] + h * q[3];
  Eigen::Matrix3d m;
  m << a.x(), b.x(), q[0].x(), a.y(), b.y(), q[0].y(), g, h, 1.0;
  return m;
}

}  // namespace

geometry::RgbImage reduced_picture(const geometry::RgbImage& image, int by) {
  geometry::RgbImage small{image.width / by, image.height / by, {}};
  small.rgb.resize(3 * static_cast<std::size_t>(small.width) * small.height);
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) {
      std::array<int, 3> sum{};
      for (int v = 0; v < by; ++v) {
        for (int u = 0; u < by; ++u) {
          const std::size_t at = pixel_offset(image, x * by + u, y * by + v);
          for (std::size_t c = 0; c < 3; ++c) sum[c] += image.rgb[at + c];
        }
      }
      for (std::size_t c = 0; c < 3; ++c) {
        small.rgb[pixel_offset(small, x, y) + c] = static_cast<std::uint8_t>(sum[c] / (by * by));
      }
    }
  }
  return small;
}

std::optional<Vec2> meeting(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const double denominator = cross2(b - a, d - c);
  if (std::abs(denominator) < 1e-9 * (b - a).norm() * (d - c).norm()) return {};
  return a + cross2(c - a, d - c) / denominator * (b - a);
}

std::optional<std::array<Vec2, 4>> four_sided(std::vector<Vec2> polygon) {
  while (polygon.size() > 4) {
    const std::size_t n = polygon.size();
    double least = std::numeric_limits<double>::infinity();
    std::size_t drop = 0;
    Vec2 at = Vec2::Zero();
    for (std::size_t i = 0; i < n; ++i) {  // edge from i to i + 1
      const Vec2 &before = polygon[(i + n - 1) % n], &a = polygon[i], &b = polygon[(i + 1) % n],
                 &after = polygon[(i + 2) % n];
      const auto corner = meeting(before, a, after, b);
      if (!corner || (*corner - a).dot(a - before) < 0.0) continue;
      const double added = std::abs(cross2(b - a, *corner - a));
      if (added < least) {
        least = added;
        drop = i;
        at = *corner;
      }
    }
    if (!std::isfinite(least)) return {};
    polygon[drop] = at;
    polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>((drop + 1) % n));
  }
  if (polygon.size() != 4) return {};
  return std::array<Vec2, 4>{polygon[0], polygon[1], polygon[2], polygon[3]};
}

double area_of(const std::vector<Vec2>& polygon) {
  double area = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    area += 0.5 * cross2(polygon[i], polygon[(i + 1) % polygon.size()]);
  }
  return area;
}

namespace {

/// The profiles of an edge, from outside to inside in steps of a pixel: `visit` gets the middle of
/// each, the direction inwards and the brightness.
void visit_profiles(
    const std::function<double(const Vec2&)>& brightness, const Vec2& from, const Vec2& to,
    const EdgeSearch& search,
    const std::function<void(const Vec2&, const Vec2&, const std::vector<double>&)>& visit) {
  const Vec2 along = (to - from).normalized();
  const Vec2 inwards(-along.y(), along.x());  // corners go round clockwise in the picture
  const int steps = static_cast<int>(std::ceil(2.0 * search.reach)) + 1;
  std::vector<double> value(steps);
  for (int k = 0; k < kEdgePlaces; ++k) {
    const Vec2 middle =
        from + (search.from_corner + (1.0 - 2.0 * search.from_corner) * (k + 0.5) / kEdgePlaces) *
                   (to - from);
    for (int i = 0; i < steps; ++i) {
      const Vec2 at = middle + (i - 0.5 * (steps - 1)) * inwards;
      double sum = 0.0;
      for (const double aside : {-1.0, 0.0, 1.0}) sum += brightness(at + aside * along);
      value[i] = sum / 3.0;
    }
    visit(middle, inwards, value);
  }
}

}  // namespace

std::vector<Vec2> edge_points(const std::function<double(const Vec2&)>& brightness,
                              const Vec2& from, const Vec2& to, const EdgeSearch& search) {
  std::vector<Vec2> points;
  visit_profiles(
      brightness, from, to, search,
      [&](const Vec2& middle, const Vec2& inwards, const std::vector<double>& value) {
        const int steps = static_cast<int>(value.size());
        // The steepest rise over a few pixels; dark before, bright behind.
        constexpr int kBaseline = 4;
        int best = -1;
        double rise = search.rise;
        for (int i = kBaseline; i + kBaseline < steps; ++i) {
          const double r = value[i + kBaseline] - value[i - kBaseline];
          if (r > rise) {
            rise = r;
            best = i;
          }
        }
        if (best < 0) return;
        const double half = 0.5 * (value[best + kBaseline] + value[best - kBaseline]);
        for (int i = best - kBaseline; i < best + kBaseline; ++i) {
          const double a = value[i], b = value[i + 1];
          if (a <= half && b > half) {
            points.push_back(middle + (i + (half - a) / (b - a) - 0.5 * (steps - 1)) * inwards);
            break;
          }
        }
      });
  return points;
}

std::optional<double> edge_width(const std::function<double(const Vec2&)>& brightness,
                                 const Vec2& from, const Vec2& to, const EdgeSearch& search) {
  std::vector<double> widths;
  visit_profiles(
      brightness, from, to, search,
      [&](const Vec2&, const Vec2&, const std::vector<double>& value) {
        // Levels well outside and well inside.
        const auto quarter = static_cast<std::ptrdiff_t>(value.size() / 4);
        const double low = statistics::median(
                         std::vector<double>(value.begin(), value.begin() + quarter)),
                     high = statistics::median(
                         std::vector<double>(value.end() - quarter, value.end()));
        if (high - low < search.rise) return;
        // The last place below a tenth before the first one above nine tenths.
        const double tenth = low + 0.1 * (high - low), most = low + 0.9 * (high - low);
        std::size_t end = 1;
        while (end < value.size() && value[end] < most) ++end;
        if (end == value.size()) return;
        std::size_t begin = end;
        while (begin > 0 && value[begin - 1] > tenth) --begin;
        if (begin == 0) return;
        const double at_end =
            static_cast<double>(end) - (value[end] - most) / (value[end] - value[end - 1]);
        const double at_begin =
            static_cast<double>(begin) - (value[begin] - tenth) / (value[begin] - value[begin - 1]);
        widths.push_back(at_end - at_begin);
      });
  if (widths.size() < kEdgePlaces / 4) return {};
  return statistics::median(std::move(widths));
}

SeenLine line_through(const std::vector<Vec2>& points) {
  SeenLine best;
  constexpr double kNear = 2.0;  // pixels
  const std::size_t stride = std::max<std::size_t>(1, points.size() / 24);
  for (std::size_t i = 0; i < points.size(); i += stride) {
    for (std::size_t j = i + 4 * stride; j < points.size(); j += stride) {
      const Vec2 d = (points[j] - points[i]).normalized();
      int count = 0;
      for (const Vec2& p : points) count += std::abs(cross2(d, p - points[i])) < kNear ? 1 : 0;
      if (count > best.points) best = {{points[i], d, 0.0}, count};
    }
  }
  for (int round = 0; round < 3 && best.points > 1; ++round) {
    std::vector<Vec2> near;
    for (const Vec2& p : points) {
      if (std::abs(cross2(best.line.direction, p - best.line.point)) < kNear) near.push_back(p);
    }
    if (near.size() < 2) break;
    best = {fit_line(near), static_cast<int>(near.size())};
  }
  return best;
}

Eigen::Matrix3d homography_of(const std::array<Vec2, 4>& corner, double width, double height) {
  Eigen::Matrix3d unit_from_sheet;
  unit_from_sheet << 1.0 / width, 0.0, 0.5, 0.0, -1.0 / height, 0.5, 0.0, 0.0, 1.0;
  return from_unit_square(corner) * unit_from_sheet;
}

}  // namespace palmar::capture
