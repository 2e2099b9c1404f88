// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "palmar/product/parts/part_spread.h"
#include "palmar/product/parts/part_triggers.h"

namespace palmar::product {
namespace {

constexpr double kLowest = 1.5, kHighest = 15.0;    // mm out of the face
constexpr double kNarrowest = 6.0, kWidest = 32.0;  // mm
constexpr double kMostSlender = 0.6;                // height over width
constexpr double kFlatShare = 1.0 / 3.0;            // of what is seen that lies on one level
constexpr double kLevel = 0.5;                      // mm; the thickness of a level
constexpr double kFinestCell = 1.0;                 // mm
constexpr int kMostCells = 250;                     // along an axis
constexpr double kNothing = -1e9;

// Heights of a product along a direction, over a grid across it.
struct HeightMap {
  Vec3 origin, u, v, up;
  double cell = 1.0;
  int columns = 0, rows = 0;
  std::vector<double> height;
  std::vector<int> triangle;

  std::size_t index(int i, int j) const { return static_cast<std::size_t>(j) * columns + i; }
};

HeightMap height_map(const geometry::TriangleMesh& mesh, const Vec3& up, const Vec3& u) {
  HeightMap map;
  map.up = up;
  map.u = u;
  map.v = up.cross(u);
  double u0 = 1e300, u1 = -1e300, v0 = 1e300, v1 = -1e300;
  for (const Vec3& p : mesh.vertices) {
    u0 = std::min(u0, map.u.dot(p));
    u1 = std::max(u1, map.u.dot(p));
    v0 = std::min(v0, map.v.dot(p));
    v1 = std::max(v1, map.v.dot(p));
  }
  map.cell = std::max(kFinestCell, std::max(u1 - u0, v1 - v0) / kMostCells);
  map.columns = static_cast<int>((u1 - u0) / map.cell) + 1;
  map.rows = static_cast<int>((v1 - v0) / map.cell) + 1;
  map.origin = u0 * map.u + v0 * map.v;
  map.height.assign(static_cast<std::size_t>(map.columns) * map.rows, kNothing);
  map.triangle.assign(map.height.size(), -1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<Eigen::Vector2d, 3> q;
    std::array<double, 3> z{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = mesh.vertices[mesh.triangles[t][k]];
      q[k] = {(map.u.dot(p) - u0) / map.cell, (map.v.dot(p) - v0) / map.cell};
      z[k] = up.dot(p);
    }
    const Eigen::Vector2d ab = q[1] - q[0], ac = q[2] - q[0];
    const double twice = ab.x() * ac.y() - ab.y() * ac.x();
    if (twice <= 1e-9) continue;  // faces away
    const auto low = [&](int c) { return std::min({q[0][c], q[1][c], q[2][c]}); };
    const auto high = [&](int c) { return std::max({q[0][c], q[1][c], q[2][c]}); };
    for (int j = static_cast<int>(std::ceil(low(1) - 0.5)); j + 0.5 <= high(1); ++j) {
      for (int i = static_cast<int>(std::ceil(low(0) - 0.5)); i + 0.5 <= high(0); ++i) {
        if (i < 0 || j < 0 || i >= map.columns || j >= map.rows) continue;
        const Eigen::Vector2d r = Eigen::Vector2d(i + 0.5, j + 0.5) - q[0];
        const double b = (r.x() * ac.y() - r.y() * ac.x()) / twice;
        const double c = (ab.x() * r.y() - ab.y() * r.x()) / twice;
        if (b < 0.0 || c < 0.0 || b + c > 1.0) continue;
        const double here = z[0] + b * (z[1] - z[0]) + c * (z[2] - z[0]);
        if (here <= map.height[map.index(i, j)]) continue;
        map.height[map.index(i, j)] = here;
        map.triangle[map.index(i, j)] = static_cast<int>(t);
      }
    }
  }
  return map;
}

// The level on which most of what is seen lies; kNothing if it is less than a third.
double flat_level(const HeightMap& map) {
  std::map<long, int> count;
  int seen = 0;
  for (const double h : map.height) {
    if (h == kNothing) continue;
    ++seen;
    ++count[std::lround(h / kLevel)];
  }
  double best = kNothing;
  int most = 0;
  for (const auto& [level, cells] : count) {
    const auto above = count.find(level + 1);
    const int both = cells + (above == count.end() ? 0 : above->second);
    if (both <= most) continue;
    most = both;
    best = kLevel * (static_cast<double>(level) + 0.5);
  }
  return most >= kFlatShare * seen ? best : kNothing;
}

void add_buttons(const HeightMap& map, const std::vector<int>& part_of_triangle,
                 std::vector<PartButton>& buttons) {
  const double level = flat_level(map);
  if (level == kNothing) return;
  std::vector<char> is_seen(map.height.size(), 0);
  const auto is_raised = [&](std::size_t k) { return map.height[k] > level + kLowest; };
  for (int j0 = 0; j0 < map.rows; ++j0) {
    for (int i0 = 0; i0 < map.columns; ++i0) {
      if (is_seen[map.index(i0, j0)] != 0 || !is_raised(map.index(i0, j0))) continue;
      int low_i = i0, high_i = i0, low_j = j0, high_j = j0;
      int cells = 0, on_level = 0, round = 0, part_cell = 0;
      double top = kNothing;
      std::vector<std::pair<int, int>> open = {{i0, j0}};
      is_seen[map.index(i0, j0)] = 1;
      while (!open.empty()) {
        const auto [i, j] = open.back();
        open.pop_back();
        ++cells;
        const std::size_t here = map.index(i, j);
        if (map.height[here] > top) {
          top = map.height[here];
          part_cell = map.triangle[here];
        }
        low_i = std::min(low_i, i);
        high_i = std::max(high_i, i);
        low_j = std::min(low_j, j);
        high_j = std::max(high_j, j);
        for (const auto& [di, dj] :
             {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)}) {
          const int a = i + di, b = j + dj;
          if (a < 0 || b < 0 || a >= map.columns || b >= map.rows) {
            ++round;  // over the edge of the face
            continue;
          }
          const std::size_t next = map.index(a, b);
          if (is_raised(next)) {
            if (is_seen[next] == 0) open.emplace_back(a, b);
            is_seen[next] = 1;
            continue;
          }
          ++round;
          if (map.height[next] > level - 2.0 * kLowest) ++on_level;
        }
      }
      const double width = map.cell * (std::min(high_i - low_i, high_j - low_j) + 1);
      const double length = map.cell * (std::max(high_i - low_i, high_j - low_j) + 1);
      const double height = top - level;
      const double filled = cells * map.cell * map.cell / (width * length);
      constexpr double kCompact = 0.6;  // of the rectangle round it; a disc fills 0.79
      constexpr double kOnLevel = 0.95;
      if (width < kNarrowest || length > kWidest || height > kHighest ||
          height > kMostSlender * width || filled < kCompact || on_level < kOnLevel * round) {
        continue;
      }
      PartButton button;
      button.part = part_of_triangle[part_cell] + 1;
      button.normal = map.up;
      button.width = width;
      button.height = height;
      button.point = map.origin + map.cell * 0.5 * (low_i + high_i + 1) * map.u +
                     map.cell * 0.5 * (low_j + high_j + 1) * map.v;
      button.point += (top - map.up.dot(button.point)) * map.up;
      buttons.push_back(button);
    }
  }
}

}  // namespace

std::vector<PartButton> buttons_of(const geometry::TriangleMesh& mesh,
                                   const std::vector<int>& part_of_triangle) {
  std::vector<PartButton> buttons;
  if (mesh.triangles.empty()) return buttons;
  const Eigen::Matrix3d axes = face_axes_of(mesh).axes;
  for (int k = 0; k < 3; ++k) {
    for (const double sign : {1.0, -1.0}) {
      add_buttons(height_map(mesh, sign * axes.col(k), axes.col((k + 1) % 3)), part_of_triangle,
                  buttons);
    }
  }
  std::stable_sort(buttons.begin(), buttons.end(),
                   [](const PartButton& a, const PartButton& b) { return a.width > b.width; });
  return buttons;
}

}  // namespace palmar::product
