// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/photo/surface/outline_by_depth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hands/capture/photo/surface/over_views.h"
#include "hands/imaging/connected_parts.h"
#include "hands/imaging/distance_transform.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/core/progress_part.h"
#include "palmar/statistics/median.h"

namespace palmar::capture {
namespace {

constexpr double kCell = 3.0;  // mm

/// Middles of the cells of the largest group.
std::vector<Vec3> largest_group(const std::vector<SurfacePoint>& points) {
  Box3 box;
  for (const SurfacePoint& p : points) box.extend(p.position.cast<double>());
  if (box.isEmpty()) return {};
  imaging::VolumeGrid grid;
  grid.spacing = Vec3::Constant(kCell);
  grid.origin = box.min();
  for (int a = 0; a < 3; ++a) {
    grid.size[a] = static_cast<int>(box.sizes()[a] / kCell) + 2;
  }
  std::vector<int> count(grid.count(), 0);
  for (const SurfacePoint& p : points) {
    const Vec3 at = grid.to_voxel(p.position.cast<double>());
    ++count[grid.at(static_cast<int>(std::lround(at.x())), static_cast<int>(std::lround(at.y())),
                    static_cast<int>(std::lround(at.z())))];
  }
  std::vector<int> filled;
  for (const int n : count) {
    if (n > 0) filled.push_back(n);
  }
  // Skin comes once per photograph that sees it; what agrees by chance is thin.
  const int least = std::max(2, statistics::median(std::move(filled)) / 4);
  imaging::VoxelMask mask(grid.count(), 0);
  for (std::size_t c = 0; c < mask.size(); ++c) mask[c] = count[c] >= least ? 1 : 0;
  const imaging::ConnectedParts parts =
      imaging::connected_parts(grid, imaging::dilated(grid, mask, kCell));
  if (parts.count() == 0) return {};
  const int largest = parts.largest();
  std::vector<Vec3> group;
  for (int k = 0; k < grid.size[2]; ++k) {
    for (int j = 0; j < grid.size[1]; ++j) {
      for (int i = 0; i < grid.size[0]; ++i) {
        const std::size_t c = grid.at(i, j, k);
        if (mask[c] != 0 && parts.part[c] == largest) {
          group.push_back(grid.to_patient(Vec3(i, j, k)));
        }
      }
    }
  }
  return group;
}

/// Pixels within `radius` of the points' images.
imaging::VoxelMask discs(const std::vector<Vec3>& points, const PhotoView& view, double radius) {
  imaging::VoxelMask inside(view.grey.size(), 0);
  for (const Vec3& point : points) {
    const Vec3 seen = view.camera.camera_from_world * point;
    const auto pixel = view.camera.project(point);
    if (!pixel) continue;
    const double r = radius * view.camera.lens.focal_x / seen.z();
    const int top = std::max(0, static_cast<int>(std::ceil(pixel->y() - r)));
    const int bottom = std::min(view.height() - 1, static_cast<int>(pixel->y() + r));
    for (int y = top; y <= bottom; ++y) {
      const double half = std::sqrt(std::max(0.0, r * r - std::pow(y - pixel->y(), 2)));
      const int from = std::max(0, static_cast<int>(std::ceil(pixel->x() - half)));
      const int to = std::min(view.width() - 1, static_cast<int>(pixel->x() + half));
      for (int x = from; x <= to; ++x) inside[view.at(x, y)] = 1;
    }
  }
  return inside;
}

}  // namespace

bool narrow_to_points(const std::vector<SurfacePoint>& points, const std::vector<PhotoView>& views,
                      double radius, std::vector<PhotoMask>& masks) {
  const std::vector<Vec3> group = largest_group(points);
  constexpr std::size_t kFewCells = 600;  // of 9 mm^2 each: a child's hand has 1500
  if (group.size() < kFewCells) return false;
  parallel_for(static_cast<int>(views.size()), [&](int i) {
    imaging::VolumeGrid grid;
    grid.size = {views[i].width(), views[i].height(), 1};
    const imaging::VoxelMask near =
        imaging::closed(grid, discs(group, views[i], radius), radius / masks[i].pixel_size);
    for (std::size_t p = 0; p < near.size(); ++p) masks[i].inside[p] &= near[p];
  });
  return true;
}

void narrow_by_depth(const std::vector<Photograph>& photographs,
                     const std::vector<PhotoView>& views, const PhotoModelOptions& options,
                     std::vector<PhotoMask>& masks, const Progress& progress) {
  constexpr double kCoarser = 3.0;
  const std::size_t count = photographs.size();
  const int reduction = reduction_for(photographs, options.box.center(), kCoarser * options.pixel);
  std::vector<PhotoView> coarse(count);
  std::vector<PackedView> packs(count);
  std::vector<PhotoMask> rough(count);
  over_views(count, part_of(progress, 0.0, 0.1), "reducing photographs", [&](std::size_t v) {
    coarse[v] = make_view(photographs[v], reduction);
    packs[v] = packed(coarse[v]);
    rough[v] = mask_hand(coarse[v], options.box, options.board_half, options.mask);
  });
  VisualHullOptions hull_options = options.hull;
  hull_options.spacing *= kCoarser;
  const VisualHull hull = make_visual_hull(coarse, rough, options.box, hull_options);
  PatchMatchOptions stereo = options.stereo;
  stereo.radius = 2;
  stereo.iterations += 2;
  stereo.behind = std::min(500.0, options.box.diagonal().norm());
  const std::vector<std::vector<int>> sources =
      choose_sources(coarse, options.box.center(), stereo);
  const geometry::RayQuery bound(hull.surface);
  std::vector<DepthMap> maps(count);
  over_views(count, part_of(progress, 0.1, 0.95), "separating the hand from what is behind it",
             [&](std::size_t v) {
               maps[v] = match_patches(coarse, packs, static_cast<int>(v), rough[v], sources[v],
                                       bound, hull.surface, stereo);
             });
  DepthFusionOptions fusion = options.fusion;
  fusion.agree *= kCoarser;
  fusion.still = 3.0;
  const FusedDepths fused = fuse_depths(coarse, maps, options.box.center(), fusion);
  constexpr double kRadius = 6.0;  // mm: two cells
  if (!narrow_to_points(fused.points, views, kRadius, masks)) {
    throw InputError(
        "the hand can't be distinguished from what is behind it, neither by its colour nor by "
        "where it is: photographs agree about hardly anything above the board; a plain blue or "
        "grey backdrop, more photographs or sharper ones help");
  }
}

}  // namespace palmar::capture
