// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/imaging/bright_regions.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <queue>
#include <string>
#include <tuple>

#include "palmar/core/error.h"

namespace palmar {
namespace {

struct Film {
  double sum = 0.0;
  double pairs = 0.0;
};

struct Basin {
  double sum = 0.0;
  double voxels = 0.0;
  std::map<int, Film> film;  ///< to the neighbours
  double level() const { return sum / voxels; }
};

std::vector<std::int32_t> watershed(const Volume& image, const VoxelMask& mask, double floor,
                                    int& basins) {
  const VolumeGrid& grid = image.grid;
  std::vector<std::size_t> order;
  for (std::size_t v = 0; v < mask.size(); ++v) {
    if (mask[v] != 0 && static_cast<double>(image.value[v]) >= floor) order.push_back(v);
  }
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return image.value[a] != image.value[b] ? image.value[a] > image.value[b] : a < b;
  });
  std::vector<std::int32_t> basin(mask.size(), -1);
  basins = 0;
  const auto nx = static_cast<std::size_t>(grid.size[0]),
             ny = static_cast<std::size_t>(grid.size[1]);
  for (const std::size_t v : order) {
    const int i = static_cast<int>(v % nx), j = static_cast<int>(v / nx % ny),
              k = static_cast<int>(v / nx / ny);
    std::size_t best = v;
    for (int z = std::max(0, k - 1); z <= std::min(grid.size[2] - 1, k + 1); ++z) {
      for (int y = std::max(0, j - 1); y <= std::min(grid.size[1] - 1, j + 1); ++y) {
        for (int x = std::max(0, i - 1); x <= std::min(grid.size[0] - 1, i + 1); ++x) {
          const std::size_t other = grid.at(x, y, z);
          if (basin[other] < 0) continue;
          if (best == v || image.value[other] > image.value[best]) best = other;
        }
      }
    }
    basin[v] = best == v ? basins++ : basin[best];
  }
  return basin;
}

}  // namespace

void BrightRegionOptions::check() const {
  if (!std::isfinite(floor)) throw UsageError("BrightRegionOptions: floor must be a number");
  if (!(depth >= 0.0) || !std::isfinite(depth)) {
    throw UsageError("BrightRegionOptions: depth must be 0 or more");
  }
}

BrightRegions bright_regions(const Volume& image, const VoxelMask& mask,
                             const BrightRegionOptions& options) {
  options.check();
  const VolumeGrid& grid = image.grid;
  if (mask.size() != grid.count() || image.value.size() != grid.count()) {
    throw UsageError("bright_regions: mask and image need one value for each of the grid's " +
                     std::to_string(grid.count()) + " voxels");
  }
  int count = 0;
  BrightRegions regions;
  regions.region = watershed(image, mask, options.floor, count);

  std::vector<Basin> basins(static_cast<std::size_t>(count));
  const std::array<std::size_t, 3> stride = {
      1, static_cast<std::size_t>(grid.size[0]),
      static_cast<std::size_t>(grid.size[0]) * static_cast<std::size_t>(grid.size[1])};
  for (int k = 0; k < grid.size[2]; ++k) {
    for (int j = 0; j < grid.size[1]; ++j) {
      for (int i = 0; i < grid.size[0]; ++i) {
        const std::size_t v = grid.at(i, j, k);
        const std::int32_t own = regions.region[v];
        if (own < 0) continue;
        Basin& basin = basins[static_cast<std::size_t>(own)];
        basin.sum += static_cast<double>(image.value[v]);
        basin.voxels += 1.0;
        const std::array<int, 3> at = {i, j, k};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          if (at[axis] + 1 >= grid.size[axis]) continue;
          const std::size_t w = v + stride[axis];
          const std::int32_t other = regions.region[w];
          if (other < 0 || other == own) continue;
          const double darker = static_cast<double>(std::min(image.value[v], image.value[w]));
          for (const auto& [a, b] : {std::pair(own, other), std::pair(other, own)}) {
            Film& film = basins[static_cast<std::size_t>(a)].film[b];
            film.sum += darker;
            film.pairs += 1.0;
          }
        }
      }
    }
  }

  const auto depth_between = [&](const Basin& a, const Basin& b, const Film& film) {
    return std::min(a.level(), b.level()) - film.sum / film.pairs;
  };
  // Shallowest film first. A merger changes the depths of all films of the merged basin a little;
  // an entry is brought up to date when its turn comes.
  using Entry = std::tuple<double, int, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  const auto offer = [&](int a, int b) {
    if (a > b) std::swap(a, b);
    const Basin& first = basins[static_cast<std::size_t>(a)];
    const double depth =
        depth_between(first, basins[static_cast<std::size_t>(b)], first.film.at(b));
    if (depth < options.depth) queue.emplace(depth, a, b);
  };
  for (int a = 0; a < count; ++a) {
    for (const auto& [b, film] : basins[static_cast<std::size_t>(a)].film) {
      if (a < b) offer(a, b);
    }
  }
  std::vector<int> into(static_cast<std::size_t>(count));
  std::iota(into.begin(), into.end(), 0);
  while (!queue.empty()) {
    auto [depth, a, b] = queue.top();
    queue.pop();
    if (into[static_cast<std::size_t>(a)] != a || into[static_cast<std::size_t>(b)] != b) continue;
    const Film& between = basins[static_cast<std::size_t>(a)].film.at(b);
    if (depth_between(basins[static_cast<std::size_t>(a)], basins[static_cast<std::size_t>(b)],
                      between) > depth) {
      offer(a, b);
      continue;
    }
    // The one with fewer neighbours goes into the other: cheap, and the same on every run.
    if (basins[static_cast<std::size_t>(a)].film.size() <
        basins[static_cast<std::size_t>(b)].film.size()) {
      std::swap(a, b);
    }
    Basin& kept = basins[static_cast<std::size_t>(a)];
    Basin& gone = basins[static_cast<std::size_t>(b)];
    into[static_cast<std::size_t>(b)] = a;
    kept.sum += gone.sum;
    kept.voxels += gone.voxels;
    kept.film.erase(b);
    gone.film.erase(a);
    for (const auto& [c, film] : gone.film) {
      Basin& third = basins[static_cast<std::size_t>(c)];
      third.film.erase(b);
      for (Film* sum : {&kept.film[c], &third.film[a]}) {
        sum->sum += film.sum;
        sum->pairs += film.pairs;
      }
      offer(a, c);
    }
    gone.film.clear();
  }

  std::vector<std::int32_t> number(static_cast<std::size_t>(count), -1);
  for (std::int32_t& r : regions.region) {
    if (r < 0) continue;
    int root = r;
    while (into[static_cast<std::size_t>(root)] != root)
      root = into[static_cast<std::size_t>(root)];
    std::int32_t& n = number[static_cast<std::size_t>(root)];
    if (n < 0) {
      n = static_cast<std::int32_t>(regions.voxels.size());
      regions.voxels.push_back(0);
    }
    r = n;
    ++regions.voxels[static_cast<std::size_t>(n)];
  }
  return regions;
}

}  // namespace palmar
