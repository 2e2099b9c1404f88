// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/photo/surface/visual_hull.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "hands/capture/photo/pinhole.h"
#include "hands/imaging/connected_parts.h"
#include "hands/imaging/gaussian_filter.h"
#include "hands/imaging/iso_surface.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"

namespace palmar::capture {
namespace {

/// The mask as an image of the part of the grid that it fills, with a border of some voxels where
/// the grid has them.
imaging::Volume cropped(const imaging::VolumeGrid& grid, const imaging::VoxelMask& mask) {
  constexpr int kBorder = 6;
  std::array<int, 3> low = grid.size, high = {-1, -1, -1};
  for (int k = 0; k < grid.size[2]; ++k) {
    for (int j = 0; j < grid.size[1]; ++j) {
      for (int i = 0; i < grid.size[0]; ++i) {
        if (mask[grid.at(i, j, k)] == 0) continue;
        const std::array<int, 3> at = {i, j, k};
        for (std::size_t a = 0; a < 3; ++a) {
          low[a] = std::min(low[a], at[a]);
          high[a] = std::max(high[a], at[a]);
        }
      }
    }
  }
  imaging::Volume image;
  image.grid = grid;
  for (std::size_t a = 0; a < 3; ++a) {
    low[a] = std::max(0, low[a] - kBorder);
    image.grid.size[a] = std::min(grid.size[a] - 1, high[a] + kBorder) - low[a] + 1;
  }
  image.grid.origin = grid.to_patient(Vec3(low[0], low[1], low[2]));
  image.value.resize(image.grid.count());
  for (int k = 0; k < image.grid.size[2]; ++k) {
    for (int j = 0; j < image.grid.size[1]; ++j) {
      for (int i = 0; i < image.grid.size[0]; ++i) {
        image.value[image.grid.at(i, j, k)] = mask[grid.at(low[0] + i, low[1] + j, low[2] + k)];
      }
    }
  }
  return image;
}

}  // namespace

void VisualHullOptions::check() const {
  if (!(spacing >= 0.2 && spacing <= 10.0)) {
    throw UsageError(fmt::format("hull spacing {:g} mm; 0.2 to 10 mm is allowed", spacing));
  }
  if (missing < 0 || missing > 100) {
    throw UsageError(fmt::format("hull missing {}; 0 to 100 is allowed", missing));
  }
  if (!(least_views >= 0.0 && least_views <= 1.0)) {
    throw UsageError(fmt::format("hull least_views {:g}; 0 to 1 is allowed", least_views));
  }
}

VisualHull make_visual_hull(const std::vector<PhotoView>& views,
                            const std::vector<PhotoMask>& masks, const Box3& box,
                            const VisualHullOptions& options) {
  options.check();
  if (views.size() != masks.size()) throw UsageError("one mask per view is required");
  imaging::VolumeGrid grid;
  grid.spacing = Vec3::Constant(options.spacing);
  grid.origin = box.min();
  for (int k = 0; k < 3; ++k) {
    grid.size[k] = static_cast<int>(std::ceil(box.sizes()[k] / options.spacing)) + 1;
  }
  std::vector<Pinhole> cameras;
  for (const PhotoView& view : views) cameras.emplace_back(view.camera);
  const int least =
      std::max(2, static_cast<int>(options.least_views * static_cast<double>(views.size())));
  imaging::VoxelMask inside(grid.count(), 0);
  parallel_for(grid.size[2], [&](int k) {
    for (int j = 0; j < grid.size[1]; ++j) {
      for (int i = 0; i < grid.size[0]; ++i) {
        const Eigen::Vector3f point = grid.to_patient(Vec3(i, j, k)).cast<float>();
        int seen = 0, missed = 0;
        for (std::size_t v = 0; v < views.size() && missed <= options.missing; ++v) {
          const Eigen::Vector3f q = cameras[v].project(point);
          if (q.z() <= 0.0F) continue;
          const int x = static_cast<int>(std::lround(q.x() / q.z()));
          const int y = static_cast<int>(std::lround(q.y() / q.z()));
          if (x < 0 || y < 0 || x >= views[v].width() || y >= views[v].height()) continue;
          ++seen;
          missed += masks[v].inside[views[v].at(x, y)] == 0 ? 1 : 0;
        }
        inside[grid.at(i, j, k)] = missed <= options.missing && seen >= least ? 1 : 0;
      }
    }
  });
  const imaging::ConnectedParts parts = imaging::connected_parts(grid, inside);
  constexpr double kLeastVolume = 10000.0;  // mm^3: a child's hand has ten times as much
  const double voxel = std::pow(options.spacing, 3);
  const double volume =
      parts.count() == 0 ? 0.0 : voxel * static_cast<double>(parts.voxels[parts.largest()]);
  if (volume < kLeastVolume) {
    throw InputError(
        fmt::format("the outlines of the hand in the photographs meet in {:.0f} mm3 only: the hand "
                    "can't be distinguished from what is behind it, is outside the box above the "
                    "middle of the board, or moved; a plain blue or grey backdrop helps",
                    volume));
  }
  inside = imaging::mask_of(parts, parts.largest());
  VisualHull hull;
  hull.occupancy = cropped(grid, inside);
  hull.occupancy = imaging::gaussian_filtered(hull.occupancy, options.spacing);
  hull.surface = imaging::iso_surface(hull.occupancy, 0.5);
  return hull;
}

}  // namespace palmar::capture
