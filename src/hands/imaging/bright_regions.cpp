// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/imaging/bright_regions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <queue>
#include <string>
#include <tuple>

#include "palmar/core/error.h"

namespace palmar::imaging {
namespace {

constexpr int kBins = 32;  // of a film's histogram, floor to the brightest voxel

struct Film {
  std::array<std::int32_t, kBins> pairs{};
  void operator+=(const Film& other) {
    for (std::size_t b = 0; b < pairs.size(); ++b) pairs[b] += other.pairs[b];
  }
  /// Bin position (0 to kBins) that a share of the pairs exceeds.
  double exceeded_by(double share) const {
    std::int64_t all = 0;
    for (const std::int32_t n : pairs) all += n;
    double left = share * static_cast<double>(all);
    for (int b = kBins - 1; b >= 0; --b) {
      const double here = pairs[b];
      if (here > 0.0 && left <= here) return b + 1.0 - left / here;
      left -= here;
    }
    return 0.0;
  }
};

struct Basin {
  double sum = 0.0;
  double voxels = 0.0;       ///< above the core level; their mean is the basin's
  std::map<int, Film> film;  ///< to the neighbours
  double level() const { return voxels > 0.0 ? sum / voxels : 0.0; }
};

struct Flooded {
  std::vector<std::int32_t> basin;
  int count = 0;
};

Flooded flood(const Volume& image, const VoxelMask& mask, const BrightRegionOptions& options) {
  const VolumeGrid& grid = image.grid;
  Flooded flooded;
  flooded.basin.assign(mask.size(), -1);
  std::vector<std::int32_t>& basin = flooded.basin;
  const auto may_flood = [&](std::size_t v) {
    return mask[v] != 0 && static_cast<double>(image.value[v]) >= options.floor;
  };
  const auto nx = static_cast<std::size_t>(grid.size[0]),
             ny = static_cast<std::size_t>(grid.size[1]);
  const auto each_neighbour = [&](std::size_t v, const auto& visit) {
    const int i = static_cast<int>(v % nx), j = static_cast<int>(v / nx % ny),
              k = static_cast<int>(v / nx / ny);
    for (int z = std::max(0, k - 1); z <= std::min(grid.size[2] - 1, k + 1); ++z) {
      for (int y = std::max(0, j - 1); y <= std::min(grid.size[1] - 1, j + 1); ++y) {
        for (int x = std::max(0, i - 1); x <= std::min(grid.size[0] - 1, i + 1); ++x) {
          const std::size_t w = grid.at(x, y, z);
          if (w != v) visit(w);
        }
      }
    }
  };
  // Brightest first, of equally bright ones the first voxel.
  const auto comes_later = [&](std::size_t a, std::size_t b) {
    return image.value[a] != image.value[b] ? image.value[a] < image.value[b] : a > b;
  };
  std::vector<std::size_t> cores;
  for (std::size_t v = 0; v < mask.size(); ++v) {
    if (may_flood(v) && static_cast<double>(image.value[v]) >= options.core) cores.push_back(v);
  }
  std::sort(cores.begin(), cores.end(),
            [&](std::size_t a, std::size_t b) { return comes_later(b, a); });
  std::priority_queue<std::size_t, std::vector<std::size_t>, decltype(comes_later)> shore(
      comes_later);
  VoxelMask is_on_shore(mask.size(), 0);
  const auto join = [&](std::size_t v, bool may_begin) {
    std::size_t best = v;
    each_neighbour(v, [&](std::size_t w) {
      if (basin[w] < 0) return;
      if (best == v || image.value[w] > image.value[best]) best = w;
    });
    if (best == v && !may_begin) return;
    basin[v] = best == v ? flooded.count++ : basin[best];
  };
  for (const std::size_t v : cores) join(v, true);
  const auto look_round = [&](std::size_t v) {
    each_neighbour(v, [&](std::size_t w) {
      if (basin[w] >= 0 || is_on_shore[w] != 0 || !may_flood(w)) return;
      is_on_shore[w] = 1;
      shore.push(w);
    });
  };
  for (const std::size_t v : cores) look_round(v);
  while (!shore.empty()) {
    const std::size_t v = shore.top();
    shore.pop();
    join(v, false);
    look_round(v);
  }
  return flooded;
}

}  // namespace

void BrightRegionOptions::check() const {
  const auto require = [](bool is_good, const char* field, double value, const char* allowed) {
    if (is_good) return;
    throw UsageError(std::string("BrightRegionOptions: ") + field + " is " + std::to_string(value) +
                     "; " + allowed + " is allowed");
  };
  require(std::isfinite(floor), "floor", floor, "any intensity");
  require(std::isfinite(core) && core >= floor, "core", core, "floor or more");
  require(std::isfinite(dark) && dark <= floor, "dark", dark, "floor or less");
  require(depth >= 0.0 && depth <= 1.0, "depth", depth, "0 to 1");
  require(leak > 0.0 && leak < 1.0, "leak", leak, "more than 0 and less than 1");
}

BrightRegions bright_regions(const Volume& image, const VoxelMask& mask,
                             const BrightRegionOptions& options) {
  options.check();
  const VolumeGrid& grid = image.grid;
  if (mask.size() != grid.count() || image.value.size() != grid.count()) {
    throw UsageError("bright_regions: mask and image need one value for each of the grid's " +
                     std::to_string(grid.count()) + " voxels");
  }
  Flooded flooded = flood(image, mask, options);
  BrightRegions regions;
  regions.region = std::move(flooded.basin);
  const int count = flooded.count;

  double highest = options.floor;
  for (std::size_t v = 0; v < mask.size(); ++v) {
    if (regions.region[v] >= 0) highest = std::max(highest, static_cast<double>(image.value[v]));
  }
  const double bin = std::max((highest - options.floor) / kBins, 1e-12);
  std::vector<Basin> basins(count);
  const std::array<std::size_t, 3> stride = {1, static_cast<std::size_t>(grid.size[0]),
                                             static_cast<std::size_t>(grid.size[0]) * grid.size[1]};
  for (int k = 0; k < grid.size[2]; ++k) {
    for (int j = 0; j < grid.size[1]; ++j) {
      for (int i = 0; i < grid.size[0]; ++i) {
        const std::size_t v = grid.at(i, j, k);
        const std::int32_t own = regions.region[v];
        if (own < 0) continue;
        Basin& basin = basins[own];
        if (static_cast<double>(image.value[v]) >= options.core) {
          basin.sum += static_cast<double>(image.value[v]);
          basin.voxels += 1.0;
        }
        const std::array<int, 3> at = {i, j, k};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          if (at[axis] + 1 >= grid.size[axis]) continue;
          const std::size_t w = v + stride[axis];
          const std::int32_t other = regions.region[w];
          if (other < 0 || other == own) continue;
          const double darker = static_cast<double>(std::min(image.value[v], image.value[w]));
          const auto b = std::clamp(static_cast<int>((darker - options.floor) / bin), 0, kBins - 1);
          ++basin.film[other].pairs[b];
          ++basins[other].film[own].pairs[b];
        }
      }
    }
  }

  const auto depth_between = [&](const Basin& a, const Basin& b, const Film& film) {
    const double lower = std::min(a.level(), b.level()) - options.dark;
    const double between = options.floor - options.dark + bin * film.exceeded_by(options.leak);
    return 1.0 - between / lower;
  };
  // Shallowest film first. A merger changes the depths of all films of the merged basin a little;
  // an entry is brought up to date when its turn comes.
  using Entry = std::tuple<double, int, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  const auto offer = [&](int a, int b) {
    if (a > b) std::swap(a, b);
    const Basin& first = basins[a];
    const double depth = depth_between(first, basins[b], first.film.at(b));
    if (depth < options.depth) queue.emplace(depth, a, b);
  };
  for (int a = 0; a < count; ++a) {
    for (const auto& [b, film] : basins[a].film) {
      if (a < b) offer(a, b);
    }
  }
  std::vector<int> into(count);
  std::iota(into.begin(), into.end(), 0);
  while (!queue.empty()) {
    auto [depth, a, b] = queue.top();
    queue.pop();
    if (into[a] != a || into[b] != b) continue;
    const Film& between = basins[a].film.at(b);
    if (depth_between(basins[a], basins[b], between) > depth) {
      offer(a, b);
      continue;
    }
    // The one with fewer neighbours goes into the other: cheap, and the same on every run.
    if (basins[a].film.size() < basins[b].film.size()) {
      std::swap(a, b);
    }
    Basin& kept = basins[a];
    Basin& gone = basins[b];
    into[b] = a;
    kept.sum += gone.sum;
    kept.voxels += gone.voxels;
    kept.film.erase(b);
    gone.film.erase(a);
    for (const auto& [c, film] : gone.film) {
      Basin& third = basins[c];
      third.film.erase(b);
      kept.film[c] += film;
      third.film[a] += film;
      offer(a, c);
    }
    gone.film.clear();
  }

  std::vector<std::int32_t> number(count, -1);
  for (std::int32_t& r : regions.region) {
    if (r < 0) continue;
    int root = r;
    while (into[root] != root) root = into[root];
    std::int32_t& n = number[root];
    if (n < 0) {
      n = static_cast<std::int32_t>(regions.voxels.size());
      regions.voxels.push_back(0);
    }
    r = n;
    ++regions.voxels[n];
  }
  return regions;
}

}  // namespace palmar::imaging
