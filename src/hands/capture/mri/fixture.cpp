// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/mri/fixture.h"

#include <algorithm>
#include <cmath>

#include "hands/imaging/connected_parts.h"

namespace palmar::capture {
namespace {

constexpr double kDeepestSkin = 5.0;    // mm from the air to something bright
constexpr double kFarthest = 12.0;      // mm; tissue of a hand has fat or marrow nearer than that
constexpr double kLikeness = 0.15;      // share by which the signal below the surface may differ
constexpr double kEvenness = 0.15;      // share that the signal inside may vary by
constexpr double kFat = 0.6;            // share of the bright signal; skin has less
constexpr std::size_t kLeastFat = 10;   // voxels
constexpr double kLeastVolume = 1.0e3;  // mm^3
constexpr double kThinnest = 1.2;       // mm, half of what the fixture is thicker than

}  // namespace

Fixture find_fixture(const imaging::Volume& smooth, const imaging::VoxelMask& tissue,
                     const imaging::VoxelMask& air, double bright, double skin, double noise) {
  const imaging::VolumeGrid& grid = smooth.grid;
  const std::size_t count = tissue.size();
  imaging::VoxelMask fat(count);
  for (std::size_t v = 0; v < count; ++v) {
    fat[v] = tissue[v] != 0 && static_cast<double>(smooth.value[v]) > kFat * bright ? 1 : 0;
  }
  // Single bright voxels are noise; the fat of a slender finger is a film of one or two.
  const imaging::ConnectedParts fat_parts =
      imaging::connected_parts(grid, fat, imaging::Neighbourhood::kCorners);
  for (std::size_t v = 0; v < count; ++v) {
    if (fat[v] != 0 && fat_parts.voxels[fat_parts.part[v]] < kLeastFat) {
      fat[v] = 0;
    }
  }
  const std::vector<float> to_fat = imaging::distance_transform(grid, fat);
  imaging::VoxelMask far(count);
  for (std::size_t v = 0; v < count; ++v) {
    far[v] = tissue[v] != 0 && static_cast<double>(to_fat[v]) > kDeepestSkin ? 1 : 0;
  }
  const std::vector<float> to_air = imaging::distance_transform(grid, air);
  const imaging::ConnectedParts parts = imaging::connected_parts(grid, far);
  struct Part {
    double open = 0.0, farthest = 0.0, squares = 0.0;
    double shallow = 0.0, shallow_voxels = 0.0, deep = 0.0, deep_voxels = 0.0;
  };
  std::vector<Part> measures(parts.voxels.size());
  const double step = 1.01 * grid.spacing.maxCoeff();
  // Below what the air's partial volume darkens.
  const double shallow = std::max(1.5, 0.5 + grid.spacing.maxCoeff());
  for (std::size_t v = 0; v < count; ++v) {
    if (parts.part[v] < 0) continue;
    Part& part = measures[parts.part[v]];
    const auto depth = static_cast<double>(to_air[v]), value = static_cast<double>(smooth.value[v]);
    part.farthest = std::max(part.farthest, static_cast<double>(to_fat[v]));
    if (depth <= step) part.open += 1.0;
    if (depth > shallow && depth < shallow + 1.0) {
      part.shallow += value;
      part.shallow_voxels += 1.0;
    } else if (depth > shallow + 2.0) {
      part.deep += value;
      part.deep_voxels += 1.0;
      part.squares += value * value;
    }
  }
  Fixture fixture;
  imaging::VoxelMask seed(count, 0);
  std::vector<char> is_fixture(parts.voxels.size(), 0);
  double total = 0.0, voxels = 0.0;
  int largest = -1;
  for (std::size_t p = 0; p < measures.size(); ++p) {
    const Part& part = measures[p];
    const auto size = static_cast<double>(parts.voxels[p]);
    if (size * grid.spacing.prod() < kLeastVolume || part.farthest < kFarthest) continue;
    // A ball's surface voxels against its volume.
    if (part.open < 0.5 * std::pow(size, 2.0 / 3.0)) continue;
    if (part.shallow_voxels == 0.0 || part.deep_voxels == 0.0) continue;
    const double below = part.shallow / part.shallow_voxels, inside = part.deep / part.deep_voxels;
    if (std::abs(below - inside) > kLikeness * inside) continue;
    const double spread =
        std::sqrt(std::max(0.0, part.squares / part.deep_voxels - inside * inside));
    if (spread > kEvenness * inside) continue;
    is_fixture[p] = 1;
    if (largest < 0 || size > static_cast<double>(parts.voxels[largest])) {
      largest = static_cast<int>(p);
    }
  }
  // One material: a piece of another signal is none of it.
  for (std::size_t p = 0; p < measures.size(); ++p) {
    if (is_fixture[p] == 0) continue;
    const Part &part = measures[p], &main = measures[largest];
    const double here = part.deep / part.deep_voxels, there = main.deep / main.deep_voxels;
    if (std::abs(here - there) > kLikeness * there) {
      is_fixture[p] = 0;
      continue;
    }
    total += part.deep;
    voxels += part.deep_voxels;
  }
  if (voxels == 0.0) return fixture;
  for (std::size_t v = 0; v < count; ++v) {
    const std::int32_t p = parts.part[v];
    seed[v] = p >= 0 && is_fixture[p] != 0 ? 1 : 0;
  }
  fixture.signal = total / voxels;
  const bool is_distinct = skin - fixture.signal > std::max(2.0 * noise, 0.1 * bright);
  fixture.boundary = is_distinct ? 0.5 * (skin + fixture.signal) : bright;
  imaging::VoxelMask alike(count);
  for (std::size_t v = 0; v < count; ++v) {
    const bool is_alike = static_cast<double>(smooth.value[v]) < fixture.boundary &&
                          (is_distinct || static_cast<double>(to_fat[v]) > 2.0);
    alike[v] = tissue[v] != 0 && is_alike ? 1 : 0;
  }
  const imaging::ConnectedParts thick =
      imaging::connected_parts(grid, imaging::opened(grid, alike, kThinnest));
  std::vector<char> is_seeded(thick.voxels.size(), 0);
  for (std::size_t v = 0; v < count; ++v) {
    if (seed[v] != 0 && thick.part[v] >= 0) {
      is_seeded[thick.part[v]] = 1;
    }
  }
  imaging::VoxelMask mask(count);
  for (std::size_t v = 0; v < count; ++v) {
    const std::int32_t p = thick.part[v];
    mask[v] = p >= 0 && is_seeded[p] != 0 ? 1 : 0;
  }
  const std::vector<float> to_mask = imaging::distance_transform(grid, mask);
  for (std::size_t v = 0; v < count; ++v) {
    const auto away = static_cast<double>(to_mask[v]);
    mask[v] = (alike[v] != 0 && away <= kThinnest + step) ? 1 : 0;
    fixture.volume += mask[v] != 0 ? grid.spacing.prod() : 0.0;
  }
  fixture.mask = std::move(mask);
  return fixture;
}

}  // namespace palmar::capture
