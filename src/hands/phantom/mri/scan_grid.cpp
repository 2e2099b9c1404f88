// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/phantom/mri/scan_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "palmar/core/error.h"

namespace palmar::phantom {
namespace {

constexpr double kTipMargin = 6.0;      // mm above the fingertips
constexpr double kForearmWidth = 60.0;  // mm; a tilted slice sees the forearm's end on one side

void check_range(const char* field, double value, double least, double most, const char* unit) {
  if (value >= least && value <= most) return;
  throw UsageError(
      fmt::format("{} is {:g} {}; {:g} to {:g} are allowed", field, value, unit, least, most));
}

}  // namespace

void ScanGridOptions::check() const {
  check_range("pixel", pixel, 0.1, 5.0, "mm");
  check_range("slice", slice, 0.1, 10.0, "mm");
  check_range("slices", slices, 2, 2000, "");
  check_range("field", field, 20.0, 500.0, "mm");
  check_range("oblique", oblique, -0.8, 0.8, "rad");
  check_range("forearm margin", forearm_margin, 0.0, 100.0, "mm");
  for (const double shift : offset) check_range("offset", shift, -200.0, 200.0, "mm");
  const double voxels = std::pow(field / pixel, 2.0) * slices;
  if (voxels > 500e6) {
    throw UsageError(
        fmt::format("{:.0f} million voxels; up to 500 million are allowed", voxels / 1e6));
  }
}

imaging::VolumeGrid scan_grid(const std::vector<Vec3>& skin, const ScanGridOptions& options) {
  options.check();
  if (skin.empty()) throw UsageError("a scan needs a hand");
  imaging::VolumeGrid grid;
  Eigen::Matrix3d coronal;
  coronal << 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -1.0, 0.0;
  const Vec3 axis = Vec3(2.0, 1.0, 1.0).normalized();  // so that all three axes become oblique
  grid.axes = Eigen::AngleAxisd(options.oblique, axis).toRotationMatrix() * coronal;
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = -low;
  for (const Vec3& vertex : skin) {
    const Vec3 along = grid.axes.transpose() * vertex;
    low = low.cwiseMin(along);
    high = high.cwiseMax(along);
  }
  grid.spacing = Vec3(options.pixel, options.pixel, options.slice);
  const int most = std::max(2, static_cast<int>(std::lround(options.field / options.pixel)));
  const double margin =
      options.forearm_margin + kForearmWidth * std::abs(std::sin(options.oblique));
  const double height = high[1] - margin - (low[1] - kTipMargin);
  const int rows = std::clamp(static_cast<int>(height / options.pixel), 2, most);
  grid.size = {most, rows, options.slices};

  // The middle of what is seen: the forearm goes on, perhaps obliquely.
  const double edge = low[1] - kTipMargin + options.pixel * rows;
  Vec3 first_seen = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 last_seen = -first_seen;
  for (const Vec3& vertex : skin) {
    const Vec3 along = grid.axes.transpose() * vertex;
    if (along[1] > edge) continue;
    first_seen = first_seen.cwiseMin(along);
    last_seen = last_seen.cwiseMax(along);
  }
  const Vec3 middle = 0.5 * (first_seen + last_seen);
  const Vec3 extent(options.pixel * (most - 1), 0.0, options.slice * (options.slices - 1));
  Vec3 first = middle - 0.5 * extent;
  first[1] = low[1] - kTipMargin;
  grid.origin = grid.axes * (first + options.offset);
  return grid;
}

}  // namespace palmar::phantom
