// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/imaging/simple_body.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <queue>
#include <string>
#include <utility>

#include "hands/imaging/connected_parts.h"
#include "hands/imaging/iso_surface.h"
#include "palmar/core/error.h"

namespace palmar::imaging {
namespace {

using Bits = std::uint32_t;
constexpr int kAround = 27, kMiddle = 13;

constexpr int steps_between(int a, int b) {
  const auto differ = [&](int divisor) { return a / divisor % 3 - b / divisor % 3; };
  int steps = 0;
  for (const int divisor : {1, 3, 9}) {
    const int d = differ(divisor);
    if (d < -1 || d > 1) return 4;
    steps += d != 0 ? 1 : 0;
  }
  return steps;
}

/// Neighbours of each of the 27 voxels but the middle one, by up to `most` steps.
constexpr std::array<Bits, kAround> neighbours(int most) {
  std::array<Bits, kAround> all{};
  for (int a = 0; a < kAround; ++a) {
    for (int b = 0; b < kAround; ++b) {
      if (a == b || b == kMiddle) continue;
      if (steps_between(a, b) <= most) all[a] |= Bits{1} << b;
    }
  }
  return all;
}
constexpr std::array<Bits, kAround> kByFaces = neighbours(1), kByEdges = neighbours(2);

Bits grown(Bits from, const std::array<Bits, kAround>& by) {
  Bits reached = from;
  for (Bits left = from; left != 0; left &= left - 1) {
    reached |= by[std::countr_zero(left)];
  }
  return reached;
}

/// Parts of `set` next to the middle, of what is reached from there within `reach` steps.
int parts_near_middle(Bits set, const std::array<Bits, kAround>& by, int reach) {
  Bits near = set & by[kMiddle];
  for (int step = 1; step < reach; ++step) near = grown(near, by) & set;
  int parts = 0;
  while (near != 0) {
    Bits part = near & (~near + 1);
    while (true) {
      const Bits more = grown(part, by) & near;
      if (more == part) break;
      part = more;
    }
    near &= ~part;
    ++parts;
  }
  return parts;
}

void require_count(const VolumeGrid& grid, std::size_t values, const char* what) {
  if (values == grid.count()) return;
  throw UsageError(std::string("simple body: ") + what + " has " + std::to_string(values) +
                   " values, the grid " + std::to_string(grid.count()) + " voxels");
}

/// The outside as seen from a border of the image that counts as outside.
VoxelMask without_bubbles(const VolumeGrid& grid, VoxelMask mask) {
  VolumeGrid wide = grid;
  for (int& n : wide.size) n += 2;
  VoxelMask outside(wide.count(), 1);
  const auto each = [&](const auto& visit) {
    for (int k = 0; k < grid.size[2]; ++k) {
      for (int j = 0; j < grid.size[1]; ++j) {
        for (int i = 0; i < grid.size[0]; ++i) {
          visit(grid.at(i, j, k), wide.at(i + 1, j + 1, k + 1));
        }
      }
    }
  };
  each([&](std::size_t v, std::size_t w) { outside[w] = mask[v] == 0 ? 1 : 0; });
  const ConnectedParts parts = connected_parts(wide, outside);
  each([&](std::size_t v, std::size_t w) { mask[v] = parts.part[w] == 0 ? 0 : 1; });
  return mask;
}

int euler_number(const geometry::TriangleMesh& mesh) {
  return mesh.vertex_count() - mesh.triangle_count() / 2;
}

}  // namespace

bool is_simple(std::uint32_t around) {
  const Bits others = ((Bits{1} << kAround) - 1) & ~(Bits{1} << kMiddle);
  const Bits body = around & others;
  return parts_near_middle(body, kByFaces, 3) == 1 &&
         parts_near_middle(~body & others, kByEdges, 2) == 1;
}

VoxelMask simple_body(const VolumeGrid& grid, const VoxelMask& mask,
                      const std::vector<float>& order) {
  require_count(grid, mask.size(), "the mask");
  require_count(grid, order.size(), "the order");
  VoxelMask body(mask.size(), 0);
  std::size_t seed = mask.size();
  for (std::size_t v = 0; v < mask.size(); ++v) {
    if (mask[v] != 0 && (seed == mask.size() || order[v] > order[seed])) seed = v;
  }
  if (seed == mask.size()) return body;

  const auto nx = static_cast<std::size_t>(grid.size[0]),
             ny = static_cast<std::size_t>(grid.size[1]);
  const auto place = [&](std::size_t v) {
    return std::array<int, 3>{static_cast<int>(v % nx), static_cast<int>(v / nx % ny),
                              static_cast<int>(v / nx / ny)};
  };
  const auto each_around = [&](std::size_t v, const auto& visit) {
    const auto [i, j, k] = place(v);
    for (int n = 0; n < kAround; ++n) {
      const int x = i + n % 3 - 1, y = j + n / 3 % 3 - 1, z = k + n / 9 - 1;
      if (n == kMiddle || x < 0 || y < 0 || z < 0 || x >= grid.size[0] || y >= grid.size[1] ||
          z >= grid.size[2]) {
        continue;
      }
      visit(n, grid.at(x, y, z));
    }
  };
  const auto comes_later = [&](std::size_t a, std::size_t b) {
    return order[a] != order[b] ? order[a] < order[b] : a > b;
  };
  std::priority_queue<std::size_t, std::vector<std::size_t>, decltype(comes_later)> shore(
      comes_later);
  VoxelMask is_waiting(mask.size(), 0);
  const auto add = [&](std::size_t v) {
    body[v] = 1;
    // What wasn't simple before may be now.
    each_around(v, [&](int, std::size_t w) {
      if (mask[w] == 0 || body[w] != 0 || is_waiting[w] != 0) return;
      is_waiting[w] = 1;
      shore.push(w);
    });
  };
  add(seed);
  while (!shore.empty()) {
    const std::size_t v = shore.top();
    shore.pop();
    is_waiting[v] = 0;
    Bits around = 0;
    each_around(v, [&](int n, std::size_t w) { around |= body[w] != 0 ? Bits{1} << n : Bits{0}; });
    if (is_simple(around)) add(v);
  }
  return body;
}

SimpleSurface simple_surface(Volume image, double level, double contrast) {
  const VolumeGrid& grid = image.grid;
  VoxelMask bright(image.value.size());
  for (std::size_t v = 0; v < bright.size(); ++v) {
    bright[v] = static_cast<double>(image.value[v]) > level ? 1 : 0;
  }
  const ConnectedParts parts = connected_parts(grid, bright);
  SimpleSurface surface;
  if (parts.count() == 0) return surface;
  const VoxelMask whole = without_bubbles(grid, mask_of(parts, parts.largest()));
  VoxelMask outside(whole.size());
  for (std::size_t v = 0; v < whole.size(); ++v) outside[v] = whole[v] == 0 ? 1 : 0;
  const auto beyond = 0.05 * std::abs(contrast);
  const auto put = [&](const VoxelMask& body) {
    for (std::size_t v = 0; v < body.size(); ++v) {
      const bool is_bright = static_cast<double>(image.value[v]) > level;
      if (is_bright == (body[v] != 0)) continue;
      image.value[v] = static_cast<float>(is_bright ? level - beyond : level + beyond);
    }
  };
  put(whole);
  surface.mesh = iso_surface(image, level);
  if (euler_number(surface.mesh) == 2) return surface;
  surface.handles = 1 - euler_number(surface.mesh) / 2;
  put(simple_body(grid, whole, distance_transform(grid, outside)));
  surface.mesh = iso_surface(image, level);
  return surface;
}

}  // namespace palmar::imaging
