// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/picture/coverage_mask.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palmar::report {
namespace {

using Eigen::Vector2d;

std::uint8_t mixed(std::uint8_t below, std::uint8_t above, double cover) {
  return static_cast<std::uint8_t>(std::lround(below + (above - below) * cover));
}

/// Corners of a disk; all disks and segments turn the same way.
std::vector<Vector2d> disk(const Vector2d& centre, double radius) {
  const int n = std::clamp(static_cast<int>(std::ceil(6.0 * std::sqrt(radius + 1.0))), 8, 200);
  std::vector<Vector2d> points;
  for (int i = 0; i < n; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / n;
    points.emplace_back(centre.x() + radius * std::cos(angle),
                        centre.y() + radius * std::sin(angle));
  }
  return points;
}

}  // namespace

CoverageMask::CoverageMask(int image_width, int image_height)
    : width_(image_width),
      height_(image_height),
      first_row_(image_height),
      last_row_(-1),
      cover_(static_cast<std::size_t>(image_height) * static_cast<std::size_t>(image_width + 2)) {}

void CoverageMask::add_polygon(std::span<const Vector2d> points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    add_edge(points[i], points[(i + 1) % points.size()]);
  }
}

void CoverageMask::add_line(std::span<const Vector2d> points, double width, bool has_round_ends) {
  const double radius = 0.5 * width;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Vector2d along = points[i + 1] - points[i];
    const double length = along.norm();
    if (length == 0.0) continue;
    const Vector2d across = Vector2d(along.y(), -along.x()) * (radius / length);
    add_polygon(std::vector<Vector2d>{points[i] + across, points[i + 1] + across,
                                      points[i + 1] - across, points[i] - across});
  }
  // A join's disk would only thicken the rim of a thin line.
  if (radius < 0.6 && !has_round_ends) return;
  for (std::size_t i = has_round_ends ? 0 : 1; i + (has_round_ends ? 0 : 1) < points.size(); ++i) {
    add_polygon(disk(points[i], radius));
  }
}

void CoverageMask::add_edge(Vector2d a, Vector2d b) {
  double sign = 1.0;
  if (a.y() > b.y()) {
    std::swap(a, b);
    sign = -1.0;
  }
  if (b.y() <= 0.0 || a.y() >= height_ || a.y() == b.y()) return;
  const double slope = (b.x() - a.x()) / (b.y() - a.y());
  const int first = std::max(0, static_cast<int>(std::floor(a.y())));
  const int last = std::min(height_ - 1, static_cast<int>(std::ceil(b.y())) - 1);
  first_row_ = std::min(first_row_, first);
  last_row_ = std::max(last_row_, last);
  for (int row = first; row <= last; ++row) {
    const double top = std::max(a.y(), static_cast<double>(row));
    const double bottom = std::min(b.y(), row + 1.0);
    if (bottom <= top) continue;
    double x0 = a.x() + slope * (top - a.y());
    double x1 = a.x() + slope * (bottom - a.y());
    if (x0 > x1) std::swap(x0, x1);
    add_slope(row, x0, x1, sign * (bottom - top));
  }
}

// Everything right of a piece of edge of a height (signed) within one row, from x0 to x1, is
// covered; the pixels that the piece crosses are covered by the part of their area right of it.
void CoverageMask::add_slope(int row, double x0, double x1, double height) {
  double* line =
      cover_.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(width_ + 2);
  const double limit = width_;
  // Beyond the edges of the picture the piece stands upright at the edge.
  const double span = x1 - x0;
  const auto upright = [&](double x, double part) {
    const int pixel = std::clamp(static_cast<int>(std::floor(x)), 0, width_);
    const double right = pixel < width_ ? pixel + 1.0 - x : 0.0;
    line[pixel] += part * right;
    line[pixel + 1] += part * (1.0 - right);
  };
  if (span < 1e-9 || x1 <= 0.0 || x0 >= limit) {
    upright(std::clamp(0.5 * (x0 + x1), 0.0, limit), height);
    return;
  }
  if (x0 < 0.0) {
    upright(0.0, height * -x0 / span);
    add_slope(row, 0.0, x1, height * x1 / span);
    return;
  }
  if (x1 > limit) {
    upright(limit, height * (x1 - limit) / span);
    add_slope(row, x0, limit, height * (limit - x0) / span);
    return;
  }
  const int first = static_cast<int>(std::floor(x0));
  for (int pixel = first; pixel < width_ && pixel < x1; ++pixel) {
    const double from = std::max(x0, static_cast<double>(pixel));
    const double to = std::min(x1, pixel + 1.0);
    if (to <= from) continue;
    const double part = height * (to - from) / span;
    const double right = pixel + 1.0 - 0.5 * (from + to);
    line[pixel] += part * right;
    line[pixel + 1] += part * (1.0 - right);
  }
}

void CoverageMask::paint(Image& image, Rgb colour, double opacity) {
  for (int row = first_row_; row <= last_row_; ++row) {
    double* line =
        cover_.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(width_ + 2);
    double sum = 0.0;
    for (int x = 0; x < width_ + 2; ++x) {
      sum += line[x];
      line[x] = 0.0;
      if (x >= width_) continue;
      const double cover = opacity * std::min(1.0, std::abs(sum));
      if (cover < 1e-4) continue;
      Rgb& pixel = image.at(x, row);
      pixel = {mixed(pixel.r, colour.r, cover), mixed(pixel.g, colour.g, cover),
               mixed(pixel.b, colour.b, cover)};
    }
  }
  first_row_ = height_;
  last_row_ = -1;
}

}  // namespace palmar::report
