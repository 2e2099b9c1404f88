// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/capture/scan_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "palmar/core/error.h"
#include "palmar/imaging/air_threshold.h"
#include "palmar/imaging/bias_field.h"
#include "palmar/imaging/connected_parts.h"
#include "palmar/imaging/denoise.h"
#include "palmar/imaging/gaussian_filter.h"

namespace palmar {
namespace {

constexpr double kMargin = 8.0;          // mm of air kept round the hand
constexpr double kLeastVolume = 60.0e3;  // mm^3: a child's hand has 100 cm^3
constexpr double kSmoothing = 0.45;      // mm

std::size_t at(int i) { return static_cast<std::size_t>(i); }

template <typename Values>
double median(Values values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return static_cast<double>(*middle);
}

/// Voxels of `mask` and everything that it encloses.
VoxelMask filled(const VolumeGrid& grid, const VoxelMask& mask) {
  VoxelMask outside(mask.size());
  for (std::size_t v = 0; v < mask.size(); ++v) outside[v] = mask[v] == 0 ? 1 : 0;
  const ConnectedParts parts = connected_parts(grid, outside);
  const int air = parts.largest();
  VoxelMask whole(mask.size());
  for (std::size_t v = 0; v < mask.size(); ++v) whole[v] = parts.part[v] == air ? 0 : 1;
  return whole;
}

/// Range of voxels that hold the mask and `margin` [mm] round it.
struct VoxelBox {
  std::array<int, 3> low, size;
};
VoxelBox box_of(const VolumeGrid& grid, const VoxelMask& mask, double margin) {
  std::array<int, 3> low = grid.size, high = {-1, -1, -1};
  for (int k = 0; k < grid.size[2]; ++k) {
    for (int j = 0; j < grid.size[1]; ++j) {
      for (int i = 0; i < grid.size[0]; ++i) {
        if (mask[grid.at(i, j, k)] == 0) continue;
        const std::array<int, 3> here = {i, j, k};
        for (std::size_t a = 0; a < 3; ++a) {
          low[a] = std::min(low[a], here[a]);
          high[a] = std::max(high[a], here[a]);
        }
      }
    }
  }
  VoxelBox box{};
  for (std::size_t a = 0; a < 3; ++a) {
    const int extra =
        static_cast<int>(std::ceil(margin / grid.spacing[static_cast<Eigen::Index>(a)]));
    box.low[a] = std::max(0, low[a] - extra);
    box.size[a] = std::min(grid.size[a] - 1, high[a] + extra) - box.low[a] + 1;
  }
  return box;
}

template <typename T>
std::vector<T> cut_out(const VolumeGrid& grid, const std::vector<T>& values, const VoxelBox& box) {
  std::vector<T> part;
  part.reserve(at(box.size[0]) * at(box.size[1]) * at(box.size[2]));
  for (int k = 0; k < box.size[2]; ++k) {
    for (int j = 0; j < box.size[1]; ++j) {
      const auto from =
          values.begin() + static_cast<long>(grid.at(box.low[0], box.low[1] + j, box.low[2] + k));
      part.insert(part.end(), from, from + box.size[0]);
    }
  }
  return part;
}

Volume cut_out(const Volume& image, const VoxelBox& box) {
  Volume part;
  part.grid = image.grid;
  part.grid.size = box.size;
  part.grid.origin = image.grid.to_patient(Vec3(box.low[0], box.low[1], box.low[2]));
  part.value = cut_out(image.grid, image.value, box);
  return part;
}

/// Two thresholds that part values into three classes of least variance within (Otsu 1979, eq.
/// 34).
std::array<double, 2> three_classes(const std::vector<float>& values) {
  if (values.empty()) return {0.0, 0.0};
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double from = *low, width = std::max(1e-9, static_cast<double>(*high) - from);
  constexpr int kBins = 128;
  std::array<double, kBins + 1> count{}, sum{};
  for (const float v : values) {
    const int bin = std::min(kBins - 1, static_cast<int>((v - from) / width * kBins));
    count[at(bin) + 1] += 1.0;
    sum[at(bin) + 1] += static_cast<double>(v);
  }
  for (std::size_t b = 1; b <= kBins; ++b) {
    count[b] += count[b - 1];
    sum[b] += sum[b - 1];
  }
  const auto between = [&](std::size_t a, std::size_t b) {
    const double n = count[b] - count[a], s = sum[b] - sum[a];
    return n > 0.0 ? s * s / n : 0.0;
  };
  std::array<double, 2> best = {from, from};
  double most = -1.0;
  for (std::size_t a = 1; a < kBins; ++a) {
    for (std::size_t b = a + 1; b < kBins; ++b) {
      const double value = between(0, a) + between(a, b) + between(b, kBins);
      if (value <= most) continue;
      most = value;
      best = {from + width * static_cast<double>(a) / kBins,
              from + width * static_cast<double>(b) / kBins};
    }
  }
  return best;
}

void find_bone_levels(ScanImage& scan, double given) {
  std::vector<float> inner;
  for (std::size_t v = 0; v < scan.body.size(); ++v) {
    if (scan.depth[v] > 2.5F) inner.push_back(scan.smooth.value[v]);
  }
  const auto [low, high] = three_classes(inner);
  std::vector<float> dark, bright;
  for (const float v : inner) {
    if (static_cast<double>(v) < low) dark.push_back(v);
    if (static_cast<double>(v) > high) bright.push_back(v);
  }
  ScanLevels& levels = scan.levels;
  levels.bright = median(bright);
  // Thin shells never reach their own signal; thick ones are the darkest of the tissue.
  std::sort(dark.begin(), dark.end());
  levels.dark = dark.empty() ? levels.air : static_cast<double>(dark[dark.size() / 20]);
  levels.bone_threshold = given > 0.0 ? given : 0.5 * (levels.dark + levels.bright);
}

}  // namespace

ScanImage prepare_scan(const Volume& image, const std::string& name, const SurfaceOptions& options,
                       const Progress& progress) {
  progress.update(0.0, "finding the hand in the image");
  // The air is what the first threshold leaves; its median is that of Rayleigh's distribution.
  Volume rough = gaussian_filtered(image, 0.8);
  const double first = air_threshold(rough);
  VoxelMask tissue(rough.value.size());
  for (std::size_t v = 0; v < tissue.size(); ++v) {
    tissue[v] = static_cast<double>(rough.value[v]) > 0.7 * first ? 1 : 0;
  }
  ConnectedParts parts = connected_parts(image.grid, tissue);
  const double voxel = image.grid.spacing.prod();
  const int largest = parts.largest();
  if (largest < 0 || static_cast<double>(parts.voxels[at(largest)]) * voxel < kLeastVolume) {
    throw InputError(fmt::format(
        "{}: no hand in the image: the largest piece of tissue has {:.0f} cm^3, a hand has more "
        "than {:.0f}",
        name, largest < 0 ? 0.0 : static_cast<double>(parts.voxels[at(largest)]) * voxel / 1e3,
        kLeastVolume / 1e3));
  }
  const VoxelBox box = box_of(image.grid, mask_of(parts, largest), kMargin);

  ScanImage scan;
  scan.image = cut_out(image, box);
  VoxelMask body = cut_out(image.grid, mask_of(parts, largest), box);
  if (options.corrects_bias) {
    progress.update(0.05, "taking the coil's field out");
    scan.image = corrected_for_bias(scan.image, body, {}, progress);
  }
  progress.update(0.5, "measuring the tissues' signals");
  scan.smooth = gaussian_filtered(scan.image, kSmoothing);
  rough = gaussian_filtered(scan.image, 0.8);
  ScanLevels& levels = scan.levels;
  const VolumeGrid& grid = scan.image.grid;
  scan.depth = distance_transform(grid, body);
  std::vector<float> air;
  for (std::size_t v = 0; v < body.size(); ++v) {
    if (scan.depth[v] > 3.0F) air.push_back(scan.image.value[v]);
  }
  levels.noise = median(air) / std::sqrt(2.0 * std::log(2.0));
  levels.air = levels.noise * std::sqrt(std::acos(-1.0) / 2.0);

  const auto depth_of = [&](const VoxelMask& mask) {
    VoxelMask outside(mask.size());
    for (std::size_t v = 0; v < mask.size(); ++v) outside[v] = mask[v] == 0 ? 1 : 0;
    return distance_transform(grid, outside);
  };
  const auto body_above = [&](double threshold) {
    VoxelMask mask(rough.value.size());
    for (std::size_t v = 0; v < mask.size(); ++v) {
      mask[v] = static_cast<double>(rough.value[v]) > threshold ? 1 : 0;
    }
    const ConnectedParts pieces = connected_parts(grid, mask);
    return filled(grid, mask_of(pieces, pieces.largest()));
  };
  body = filled(grid, body);
  scan.depth = depth_of(body);
  std::vector<float> skin;
  for (std::size_t v = 0; v < body.size(); ++v) {
    if (scan.depth[v] > 1.2F && scan.depth[v] < 2.0F) skin.push_back(scan.image.value[v]);
  }
  levels.air_threshold =
      options.air_threshold > 0.0 ? options.air_threshold : 0.5 * (levels.air + median(skin));
  scan.body = body_above(levels.air_threshold);
  scan.depth = depth_of(scan.body);
  find_bone_levels(scan, options.bone_threshold);
  return scan;
}

}  // namespace palmar
