// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/mri/scan_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "hands/capture/mri/surface_markers.h"
#include "hands/imaging/air_threshold.h"
#include "hands/imaging/bias_field.h"
#include "hands/imaging/connected_parts.h"
#include "hands/imaging/denoise.h"
#include "hands/imaging/gaussian_filter.h"
#include "hands/imaging/noise_floor.h"
#include "hands/imaging/tissue_noise.h"
#include "palmar/core/error.h"
#include "palmar/core/progress_part.h"
#include "palmar/statistics/median.h"

namespace palmar::capture {
namespace {

constexpr double kMargin = 8.0;          // mm of air kept round the hand
constexpr double kLeastVolume = 60.0e3;  // mm^3: a child's hand has 100 cm^3
constexpr double kSmoothing = 0.45;      // mm
constexpr double kRoughly = 0.8;         // mm
constexpr double kDeep = 2.0;            // mm below the skin: no edge of it

/// Air round the tissue: what reaches the outside through openings wider than 3 mm, and 4 mm into
/// narrower ones. Dark tissue (tendons, cortical bone) that comes close to the skin is none.
imaging::VoxelMask air_round(const imaging::VolumeGrid& grid, const imaging::VoxelMask& tissue) {
  imaging::VoxelMask dark(tissue.size());
  for (std::size_t v = 0; v < tissue.size(); ++v) dark[v] = tissue[v] == 0 ? 1 : 0;
  const imaging::ConnectedParts wide =
      imaging::connected_parts(grid, imaging::opened(grid, dark, 1.5));
  imaging::VoxelMask air = imaging::mask_of(wide, wide.largest());
  const std::vector<float> from_air = imaging::distance_transform(grid, air);
  for (std::size_t v = 0; v < air.size(); ++v) air[v] = dark[v] != 0 && from_air[v] <= 4.0F ? 1 : 0;
  // What lies behind a wall isn't reached.
  const imaging::ConnectedParts reached = imaging::connected_parts(grid, air);
  return imaging::mask_of(reached, reached.largest());
}

/// Tissue and everything that it encloses.
imaging::VoxelMask filled(const imaging::VolumeGrid& grid, const imaging::VoxelMask& tissue) {
  imaging::VoxelMask whole = air_round(grid, tissue);
  for (std::uint8_t& v : whole) v = v == 0 ? 1 : 0;
  return whole;
}

/// Range of voxels that hold the mask and `margin` [mm] round it.
struct VoxelBox {
  std::array<int, 3> low, size;
};
VoxelBox box_of(const imaging::VolumeGrid& grid, const imaging::VoxelMask& mask, double margin) {
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
std::vector<T> cut_out(const imaging::VolumeGrid& grid, const std::vector<T>& values,
                       const VoxelBox& box) {
  std::vector<T> part;
  part.reserve(static_cast<std::size_t>(box.size[0]) * box.size[1] * box.size[2]);
  for (int k = 0; k < box.size[2]; ++k) {
    for (int j = 0; j < box.size[1]; ++j) {
      const auto from =
          values.begin() + static_cast<long>(grid.at(box.low[0], box.low[1] + j, box.low[2] + k));
      part.insert(part.end(), from, from + box.size[0]);
    }
  }
  return part;
}

imaging::Volume cut_out(const imaging::Volume& image, const VoxelBox& box) {
  imaging::Volume part;
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
    count[bin + 1] += 1.0;
    sum[bin + 1] += static_cast<double>(v);
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
  for (std::size_t v = 0; v < scan.depth.size(); ++v) {
    if (scan.depth[v] > 2.5F) inner.push_back(scan.smooth.value[v]);
  }
  const auto [low, high] = three_classes(inner);
  std::vector<float> bright, below;
  for (const float v : inner) {
    if (static_cast<double>(v) < low) below.push_back(v);
  }
  const double muscle = three_classes(below)[0];
  imaging::VoxelMask is_dark(scan.depth.size(), 0);
  for (std::size_t v = 0; v < scan.depth.size(); ++v) {
    if (scan.depth[v] <= 2.5F) continue;
    const float value = scan.smooth.value[v];
    if (static_cast<double>(value) > high) bright.push_back(value);
    if (static_cast<double>(value) < muscle) is_dark[v] = 1;
  }
  // Thin shells never reach their own signal; what is dark all round does: thick ones and tendons.
  // Muscle lies between.
  const imaging::VolumeGrid& grid = scan.smooth.grid;
  const imaging::VoxelMask thick = imaging::eroded(grid, is_dark, 1.01 * grid.spacing.minCoeff());
  std::vector<float> dark;
  for (std::size_t v = 0; v < thick.size(); ++v) {
    if (thick[v] != 0) dark.push_back(scan.smooth.value[v]);
  }
  ScanLevels& levels = scan.levels;
  levels.bright = statistics::median(bright);
  levels.dark = statistics::median(dark);
  levels.bone_threshold = given > 0.0 ? given : 0.5 * (levels.dark + levels.bright);
}

/// Pieces of tissue that may be a hand: large enough, and bright in parts.
std::vector<int> hands_among(const imaging::ConnectedParts& parts, const imaging::Volume& rough,
                             double threshold) {
  const double voxel = rough.grid.spacing.prod();
  std::vector<float> values;
  for (std::size_t v = 0; v < rough.value.size(); ++v) {
    if (parts.part[v] >= 0) values.push_back(rough.value[v]);
  }
  const double bright = three_classes(values)[1];
  std::vector<double> share(parts.voxels.size(), 0.0);
  for (std::size_t v = 0; v < rough.value.size(); ++v) {
    if (parts.part[v] >= 0 && static_cast<double>(rough.value[v]) > std::max(bright, threshold)) {
      share[parts.part[v]] += 1.0 / static_cast<double>(parts.voxels[parts.part[v]]);
    }
  }
  std::vector<int> hands;
  for (int p = 0; p < parts.count(); ++p) {
    if (static_cast<double>(parts.voxels[p]) * voxel > kLeastVolume && share[p] > 0.08) {
      hands.push_back(p);
    }
  }
  std::sort(hands.begin(), hands.end(),
            [&](int a, int b) { return parts.voxels[a] > parts.voxels[b]; });
  return hands;
}

Vec3 middle_of(const imaging::VolumeGrid& grid, const imaging::ConnectedParts& parts, int part) {
  Vec3 sum = Vec3::Zero();
  for (int k = 0; k < grid.size[2]; ++k) {
    for (int j = 0; j < grid.size[1]; ++j) {
      for (int i = 0; i < grid.size[0]; ++i) {
        if (parts.part[grid.at(i, j, k)] == part) sum += Vec3(i, j, k);
      }
    }
  }
  return grid.to_patient(sum / static_cast<double>(parts.voxels[part]));
}

/// The piece of tissue that is the hand. Throws InputError for none and for two.
imaging::VoxelMask the_hand(const imaging::Volume& rough, double threshold,
                            const std::string& name) {
  imaging::VoxelMask tissue(rough.value.size());
  for (std::size_t v = 0; v < tissue.size(); ++v) {
    tissue[v] = static_cast<double>(rough.value[v]) > threshold ? 1 : 0;
  }
  const imaging::ConnectedParts parts = imaging::connected_parts(rough.grid, tissue);
  const std::vector<int> hands = hands_among(parts, rough, threshold);
  const double voxel = rough.grid.spacing.prod() / 1e3;
  const auto volume = [&](int part) { return static_cast<double>(parts.voxels[part]) * voxel; };
  if (hands.empty()) {
    const int largest = parts.largest();
    throw InputError(fmt::format(
        "{}: no hand in the image: the largest piece of tissue has {:.0f} cm^3; a hand has more "
        "than {:.0f} cm^3 with bright fat and marrow in it (T1-weighted)",
        name, largest < 0 ? 0.0 : volume(largest), kLeastVolume / 1e3));
  }
  if (hands.size() > 1 && volume(hands[1]) > 0.4 * volume(hands[0])) {
    const Vec3 a = middle_of(rough.grid, parts, hands[0]),
               b = middle_of(rough.grid, parts, hands[1]);
    throw InputError(fmt::format(
        "{}: two hands in the image, of {:.0f} cm^3 round ({:.0f}, {:.0f}, {:.0f}) mm and {:.0f} "
        "cm^3 round ({:.0f}, {:.0f}, {:.0f}) mm (patient axes); one is allowed: cut the series to "
        "the one that is wanted",
        name, volume(hands[0]), a.x(), a.y(), a.z(), volume(hands[1]), b.x(), b.y(), b.z()));
  }
  return imaging::mask_of(parts, hands.front());
}

/// How deep voxels lie in a mask, mm.
std::vector<float> depth_in(const imaging::VolumeGrid& grid, const imaging::VoxelMask& mask) {
  imaging::VoxelMask outside(mask.size());
  for (std::size_t v = 0; v < mask.size(); ++v) outside[v] = mask[v] == 0 ? 1 : 0;
  return imaging::distance_transform(grid, outside);
}

/// A threshold of the user's in the numbers of an image without noise floor; 0: none is given.
double given_threshold(double threshold, double noise) {
  return threshold > 0.0 ? imaging::without_noise_floor(threshold, noise) : 0.0;
}

/// From what the air shows: the median of Rayleigh's distribution. 0 where the scanner masked it.
double air_noise(std::vector<float> air) {
  return static_cast<double>(statistics::median(std::move(air))) / std::sqrt(2.0 * std::log(2.0));
}

struct MeasuredScan {
  ScanImage scan;             ///< without body, markers and fixture
  imaging::VoxelMask tissue;  ///< of the hand, roughly
  imaging::Volume rough;
};

/// Cuts out, cleans and measures the signals.
MeasuredScan measured_scan(const imaging::Volume& image, const std::string& name,
                           const SurfaceOptions& options, const Progress& progress) {
  progress.update(0.0, "finding the hand in the image");
  imaging::Volume rough = imaging::gaussian_filtered(image, kRoughly);
  const imaging::VoxelMask whole = the_hand(rough, 0.7 * imaging::air_threshold(rough), name);
  const VoxelBox box = box_of(image.grid, whole, kMargin);

  ScanImage scan;
  scan.image = cut_out(image, box);
  const imaging::VolumeGrid& grid = scan.image.grid;
  imaging::VoxelMask tissue = cut_out(image.grid, whole, box);
  if (options.corrects_bias) {
    progress.update(0.1, "taking the coil's field out");
    scan.image = imaging::corrected_for_bias(scan.image, tissue, {}, part_of(progress, 0.1, 0.8));
  }
  progress.update(0.8, "measuring the tissues' signals");
  ScanLevels& levels = scan.levels;
  std::vector<float> air;
  const std::vector<float> from_tissue = imaging::distance_transform(grid, tissue);
  for (std::size_t v = 0; v < tissue.size(); ++v) {
    if (from_tissue[v] > 3.0F) air.push_back(scan.image.value[v]);
  }
  levels.floor = air_noise(std::move(air));
  levels.noise = levels.floor > 0.0
                     ? levels.floor
                     : imaging::tissue_noise(scan.image, depth_in(grid, tissue), kDeep);
  scan.image = imaging::without_noise_floor(std::move(scan.image), levels.floor);
  scan.smooth = imaging::gaussian_filtered(scan.image, kSmoothing);
  rough = imaging::gaussian_filtered(scan.image, kRoughly);

  const auto median_at_depth = [&](const imaging::VoxelMask& mask) {
    const std::vector<float> depth = depth_in(grid, mask);
    std::vector<float> values;
    for (std::size_t v = 0; v < mask.size(); ++v) {
      if (depth[v] > 1.0F && depth[v] < 1.8F) values.push_back(scan.image.value[v]);
    }
    return statistics::median(values);
  };
  tissue = filled(grid, tissue);
  scan.depth = depth_in(grid, tissue);
  find_bone_levels(scan, given_threshold(options.bone_threshold, levels.floor));
  levels.skin = median_at_depth(tissue);
  levels.air_threshold = options.air_threshold > 0.0
                             ? given_threshold(options.air_threshold, levels.floor)
                             : 0.5 * levels.skin;
  for (std::size_t v = 0; v < tissue.size(); ++v) {
    tissue[v] = static_cast<double>(rough.value[v]) > 0.9 * levels.air_threshold ? 1 : 0;
  }

  return {std::move(scan), std::move(tissue), std::move(rough)};
}

}  // namespace

ScanLevels scan_levels(const imaging::Volume& image, const std::string& name,
                       const SurfaceOptions& options, const Progress& progress) {
  return measured_scan(image, name, options, progress).scan.levels;
}

ScanImage prepare_scan(const imaging::Volume& image, const std::string& name,
                       const SurfaceOptions& options, const Progress& progress) {
  auto [scan, tissue, rough] = measured_scan(image, name, options, part_of(progress, 0.0, 0.6));
  const imaging::VolumeGrid& grid = scan.image.grid;
  ScanLevels& levels = scan.levels;
  progress.update(0.6, "markers and fixture");
  imaging::VoxelMask taken(tissue.size(), 0);
  if (options.marker_diameter > 0.0) {
    SurfaceMarkers markers = find_surface_markers(scan.image, filled(grid, tissue),
                                                  0.7 * levels.bright, options.marker_diameter);
    scan.markers = std::move(markers.centre);
    taken = std::move(markers.mask);
  }
  for (std::size_t v = 0; v < tissue.size(); ++v) {
    if (taken[v] != 0) tissue[v] = 0;
  }
  scan.fixture = find_fixture(rough, tissue, air_round(grid, tissue), levels.bright, levels.skin,
                              levels.floor);
  if (!scan.fixture.mask.empty()) {
    scan.notes.push_back(
        fmt::format("a fixture of {:.0f} cm^3 was taken off the hand", scan.fixture.volume / 1e3));
    for (std::size_t v = 0; v < tissue.size(); ++v) {
      if (scan.fixture.mask[v] != 0) taken[v] = 1;
    }
  }
  for (std::size_t v = 0; v < tissue.size(); ++v) {
    const bool is_tissue =
        static_cast<double>(rough.value[v]) > levels.air_threshold && taken[v] == 0;
    tissue[v] = is_tissue ? 1 : 0;
  }
  scan.covered = std::move(taken);
  const imaging::ConnectedParts pieces = imaging::connected_parts(grid, tissue);
  // Closed over what is narrower than 3 mm (dark tendons below the skin), opened where the fixture
  // leaves scraps.
  scan.body = filled(grid, imaging::closed(grid, imaging::mask_of(pieces, pieces.largest()), 1.5));
  scan.body = imaging::opened(grid, scan.body, 1.2);
  const imaging::ConnectedParts whole_parts = imaging::connected_parts(grid, scan.body);
  scan.body = imaging::mask_of(whole_parts, whole_parts.largest());
  scan.depth = depth_in(grid, scan.body);
  find_bone_levels(scan, given_threshold(options.bone_threshold, levels.floor));
  return scan;
}

}  // namespace palmar::capture
