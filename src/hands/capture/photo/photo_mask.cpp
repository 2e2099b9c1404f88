// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/photo/photo_mask.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "hands/imaging/connected_parts.h"
#include "hands/imaging/distance_transform.h"
#include "palmar/core/error.h"
#include "palmar/geometry/convex_hull.h"

namespace palmar::capture {
namespace {

using Points = std::vector<Eigen::Vector2d>;

/// Pixels within the outline of points of the world; everything if one lies behind the camera.
imaging::VoxelMask region_of(const PhotoView& view, const std::vector<Vec3>& points) {
  imaging::VoxelMask region(view.grey.size(), 1);
  Points projected;
  for (const Vec3& point : points) {
    const auto pixel = view.camera.project(point);
    if (!pixel) return region;
    projected.push_back(*pixel);
  }
  const Points outline = geometry::convex_hull(projected);
  for (int y = 0; y < view.height(); ++y) {
    double from = view.width(), to = -1.0;  // where the row crosses the outline
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Eigen::Vector2d& a = outline[i];
      const Eigen::Vector2d& b = outline[(i + 1) % outline.size()];
      if ((a.y() <= y) == (b.y() <= y)) continue;
      const double x = a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
      from = std::min(from, x);
      to = std::max(to, x);
    }
    for (int x = 0; x < view.width(); ++x) {
      if (x < from || x > to) region[view.at(x, y)] = 0;
    }
  }
  return region;
}

std::vector<Vec3> corners_of(const Box3& box) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) {
    corners.push_back(box.corner(static_cast<Box3::CornerType>(i)));
  }
  return corners;
}

/// Means of 3 x 3 pixels.
std::vector<Eigen::Vector3f> blurred(const geometry::RgbImage& image) {
  std::vector<Eigen::Vector3f> result(image.rgb.size() / 3);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) {
          const std::size_t at = pixel_offset(image, std::clamp(x + i, 0, image.width - 1),
                                              std::clamp(y + j, 0, image.height - 1));
          sum += Eigen::Vector3f(image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]);
        }
      }
      result[pixel_offset(image, x, y) / 3] = sum / 9.0F;
    }
  }
  return result;
}

/// Pixels of the board, whose half edge is `half` mm; none without a board.
imaging::VoxelMask board_region(const PhotoView& view, double half) {
  if (half <= 0.0) return imaging::VoxelMask(view.grey.size(), 0);
  return region_of(
      view, {{-half, -half, 0.0}, {half, -half, 0.0}, {half, half, 0.0}, {-half, half, 0.0}});
}

/// Colour of the board's paper: mean of the brighter third of its pixels outside of the box; white
/// if it isn't seen.
Eigen::Vector3f paper_of(const PhotoView& view, const std::vector<Eigen::Vector3f>& colour,
                         const imaging::VoxelMask& box, double half) {
  const Eigen::Vector3f white = Eigen::Vector3f::Constant(255.0F);
  if (half <= 0.0) return white;
  const imaging::VoxelMask board = board_region(view, half);
  std::vector<std::pair<float, std::size_t>> seen;
  for (std::size_t p = 0; p < colour.size(); ++p) {
    if (board[p] != 0 && box[p] == 0) seen.emplace_back(colour[p].sum(), p);
  }
  constexpr std::size_t kFew = 500;
  if (seen.size() < kFew) return white;
  const std::size_t first = seen.size() * 2 / 3;
  std::nth_element(seen.begin(), seen.begin() + static_cast<long>(first), seen.end());
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (std::size_t i = first; i < seen.size(); ++i) sum += colour[seen[i].second];
  const Eigen::Vector3f mean = sum / static_cast<float>(seen.size() - first);
  return mean.cwiseMax(1.0F);
}

/// The view as an image one voxel thick.
imaging::VolumeGrid flat_grid(const PhotoView& view) {
  imaging::VolumeGrid grid;
  grid.size = {view.width(), view.height(), 1};
  return grid;
}

/// Fills parts of the outside with at most `most` pixels.
void fill_holes(const imaging::VolumeGrid& grid, imaging::VoxelMask& mask, double most) {
  imaging::VoxelMask outside(mask.size());
  for (std::size_t p = 0; p < mask.size(); ++p) outside[p] = mask[p] == 0 ? 1 : 0;
  const imaging::ConnectedParts parts = imaging::connected_parts(grid, outside);
  for (std::size_t p = 0; p < mask.size(); ++p) {
    if (parts.part[p] >= 0 && static_cast<double>(parts.voxels[parts.part[p]]) <= most) {
      mask[p] = 1;
    }
  }
}

/// Forgets specks.
void drop_specks(const imaging::VolumeGrid& grid, imaging::VoxelMask& mask) {
  constexpr std::size_t kShare = 100;  // of the largest part
  const imaging::ConnectedParts parts = imaging::connected_parts(grid, mask);
  if (parts.count() == 0) return;
  const std::size_t least = parts.voxels[parts.largest()] / kShare;
  for (std::size_t p = 0; p < mask.size(); ++p) {
    if (parts.part[p] >= 0 && parts.voxels[parts.part[p]] < least) {
      mask[p] = 0;
    }
  }
}

/// `colour`: over the paper's. Neither nearly black, nor grey, nor blue.
bool looks_like_skin(const Eigen::Vector3f& colour, const PhotoMaskOptions& options) {
  const float sum = colour.sum();
  if (sum < 3.0 * options.dark) return false;
  const double red = colour[0] / sum, blue = colour[2] / sum;
  constexpr double kGrey = 1.0 / 3.0;
  const bool is_neutral =
      std::abs(red - kGrey) < options.neutral && std::abs(blue - kGrey) < options.neutral;
  const bool is_blue = blue - red > options.blue && colour[2] > colour[1];
  return !is_neutral && !is_blue;
}

}  // namespace

void PhotoMaskOptions::check() const {
  const auto require = [](bool holds, const char* field, double value, const char* allowed) {
    if (!holds)
      throw UsageError(fmt::format("mask {}: {:g}; {} is allowed", field, value, allowed));
  };
  require(neutral >= 0.0 && neutral < 0.3, "neutral", neutral, "0 to 0.3");
  require(blue >= 0.0 && blue <= 1.0, "blue", blue, "0 to 1");
  require(dark >= 0.0 && dark < 1.0, "dark", dark, "0 to 1");
  require(close >= 0.0 && close <= 10.0, "close", close, "0 to 10 mm");
  require(fill >= 0.0 && fill <= 1000.0, "fill", fill, "0 to 1000 mm^2");
  require(grow >= 0.0 && grow <= 10.0, "grow", grow, "0 to 10 mm");
}

PhotoMask mask_hand(const PhotoView& view, const Box3& box, double board_half,
                    const PhotoMaskOptions& options) {
  options.check();
  PhotoMask result;
  result.pixel_size =
      (view.camera.camera_from_world * box.center()).norm() / view.camera.lens.focal_x;
  const imaging::VoxelMask region = region_of(view, corners_of(box));
  const std::vector<Eigen::Vector3f> colour = blurred(view.colour);
  result.paper = paper_of(view, colour, region, board_half);

  imaging::VoxelMask mask(view.grey.size(), 0);
  // The board is neutral, so it shows nothing of what is behind the hand.
  const imaging::VoxelMask board = board_region(view, board_half);
  std::size_t region_size = 0, outside = 0, around = 0;
  for (std::size_t p = 0; p < mask.size(); ++p) {
    if (region[p] == 0 && board[p] != 0) continue;
    const bool may_be_hand = looks_like_skin(colour[p].cwiseQuotient(result.paper), options);
    if (region[p] != 0) {
      ++region_size;
      mask[p] = may_be_hand ? 1 : 0;
    } else {
      ++outside;
      around += may_be_hand ? 1 : 0;
    }
  }
  constexpr std::size_t kFew = 20;  // a twentieth of the picture
  if (outside > mask.size() / kFew) {
    result.around_share = static_cast<double>(around) / static_cast<double>(outside);
  }
  // In pixels; the flat grid has a spacing of 1.
  const double pixel = result.pixel_size;
  const imaging::VolumeGrid grid = flat_grid(view);
  drop_specks(grid, mask);
  if (options.close > 0.0) mask = imaging::closed(grid, mask, options.close / pixel);
  fill_holes(grid, mask, options.fill / (pixel * pixel));
  if (options.grow > 0.0) mask = imaging::dilated(grid, mask, options.grow / pixel);
  std::size_t inside = 0;
  for (std::size_t p = 0; p < mask.size(); ++p) {
    if (region[p] == 0) mask[p] = 0;
    inside += mask[p];
  }
  result.box_share =
      region_size == 0 ? 0.0 : static_cast<double>(inside) / static_cast<double>(region_size);
  result.inside = std::move(mask);
  return result;
}

}  // namespace palmar::capture
