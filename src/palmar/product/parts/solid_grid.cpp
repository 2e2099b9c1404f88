// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/parts/solid_grid.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/product/parts/voxel_distance.h"

namespace palmar::product {
namespace {

// A pocket without a floor is open on at most this share of its surface: a tube longer than wide on
// less than 1/3; the opening of a handle, whose bar is thinner than the opening is wide, on about a
// half.
constexpr double kLargestMouth = 0.36;
// What has a floor is a dish, however shallow: one end is open, the other at most on this share as
// much (holes of a sieve, faults of a scan).
constexpr double kFloorLeak = 0.1;
// Columns run beside the voxel centres by these shares of a voxel, so that they meet no edge of a
// mesh whose vertices lie on round numbers.
constexpr double kOffsetU = 1.37e-4, kOffsetV = 0.91e-4;

// Axes by where the surface faces, sum A n n^T: those of a cup are its own, however its handle sits
// on it. Sums over area, so they don't depend on how the surface is cut into triangles.
GridFrame own_frame(const geometry::TriangleMesh& mesh) {
  double area = 0.0;
  const Vec3 base = mesh.vertices[mesh.triangles.front()[0]];
  Eigen::Matrix3d facing = Eigen::Matrix3d::Zero();
  for (const Triangle& t : mesh.triangles) {
    const Vec3 n = (mesh.vertices[t[1]] - mesh.vertices[t[0]])
                       .cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]);
    const double length = n.norm();
    area += length;
    if (length > 0.0) facing += n * n.transpose() / length;
  }
  GridFrame frame;
  frame.origin = base;
  if (!(area > 0.0)) return frame;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(facing / area);
  frame.axes = solver.eigenvectors();
  Vec3 mean = Vec3::Zero(), third = Vec3::Zero();
  const auto for_each = [&](const auto& body) {
    for (const Triangle& t : mesh.triangles) {
      const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
      body(frame.to_grid((a + b + c) / 3.0), geometry::triangle_area(a, b, c));
    }
  };
  for_each([&](const Vec3& x, double A) { mean += 2.0 * A / area * x; });
  for_each([&](const Vec3& x, double A) {
    third += A * (x - mean).cwiseProduct(x - mean).cwiseProduct(x - mean);
  });
  for (int k = 0; k < 3; ++k) {
    if (third[k] < 0.0) frame.axes.col(k) = -frame.axes.col(k);
  }
  return frame;
}

struct Crossing {
  int column = 0;
  float height = 0.0F;
  int sign = 0;
};

// Adds a vote to every voxel inside along one axis.
void vote_along(const std::vector<Vec3>& x, const std::vector<Triangle>& triangles,
                std::size_t axis, SolidGrid& grid, std::vector<std::uint8_t>& votes) {
  const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
  const double h = grid.spacing;
  const auto first = [&](std::size_t a) { return -0.5 * (grid.size[a] - 1) * h; };
  const double u0 = first(u) + kOffsetU * h, v0 = first(v) + kOffsetV * h;
  std::vector<Crossing> crossings;
  for (const Triangle& t : triangles) {
    const Vec3 &a = x[t[0]], &b = x[t[1]], &c = x[t[2]];
    const double twice = (b[u] - a[u]) * (c[v] - a[v]) - (b[v] - a[v]) * (c[u] - a[u]);
    if (twice == 0.0) continue;
    const auto low = [&](std::size_t k, double start) {
      return std::max(0, static_cast<int>(std::ceil((std::min({a[k], b[k], c[k]}) - start) / h)));
    };
    const auto high = [&](std::size_t k, double start) {
      return std::min(grid.size[k] - 1,
                      static_cast<int>(std::floor((std::max({a[k], b[k], c[k]}) - start) / h)));
    };
    const int i1 = high(u, u0), j1 = high(v, v0);
    for (int j = low(v, v0); j <= j1; ++j) {
      for (int i = low(u, u0); i <= i1; ++i) {
        const double pu = u0 + i * h, pv = v0 + j * h;
        const double wa = ((b[u] - pu) * (c[v] - pv) - (b[v] - pv) * (c[u] - pu)) / twice;
        const double wb = ((c[u] - pu) * (a[v] - pv) - (c[v] - pv) * (a[u] - pu)) / twice;
        const double wc = 1.0 - wa - wb;
        if (wa < 0.0 || wb < 0.0 || wc < 0.0) continue;
        crossings.push_back({i + grid.size[u] * j,
                             static_cast<float>(wa * a[axis] + wb * b[axis] + wc * c[axis]),
                             twice < 0.0 ? 1 : -1});
      }
    }
  }
  std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
    if (a.column != b.column) return a.column < b.column;
    return a.height < b.height;
  });
  const double w0 = first(axis);
  std::array<int, 3> at{};
  int winding = 0;
  for (std::size_t k = 0; k + 1 < crossings.size(); ++k) {
    const Crossing& here = crossings[k];
    if (k == 0 || crossings[k - 1].column != here.column) winding = 0;
    winding += here.sign;
    if (winding <= 0 || crossings[k + 1].column != here.column) continue;
    at[u] = here.column % grid.size[u];
    at[v] = here.column / grid.size[u];
    const int begin = std::max(0, static_cast<int>(std::ceil((here.height - w0) / h)));
    const int end = std::min(grid.size[axis] - 1,
                             static_cast<int>(std::floor((crossings[k + 1].height - w0) / h)));
    for (int w = begin; w <= end; ++w) {
      at[axis] = w;
      ++votes[grid.index(at[0], at[1], at[2])];
    }
  }
}

// Voxels that the surface runs through: a wall thinner than a voxel stays a wall.
void add_surface(const std::vector<Vec3>& x, const std::vector<Triangle>& triangles,
                 SolidGrid& grid) {
  const double h = grid.spacing;
  Vec3 first;
  for (int a = 0; a < 3; ++a) first[a] = -0.5 * grid.size[a] * h;
  for (const Triangle& t : triangles) {
    const Vec3 a = x[t[0]], ab = x[t[1]] - a, ac = x[t[2]] - a;
    const double longest = std::max({ab.norm(), ac.norm(), (ab - ac).norm()});
    const int n = std::max(1, static_cast<int>(std::ceil(longest / (0.6 * h))));
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; i + j <= n; ++j) {
        const Vec3 q =
            (a + ab * (static_cast<double>(i) / n) + ac * (static_cast<double>(j) / n) - first) / h;
        grid.is_solid[grid.index(static_cast<int>(q.x()), static_cast<int>(q.y()),
                                 static_cast<int>(q.z()))] = 1;
      }
    }
  }
}

void close_gaps(double radius, SolidGrid& grid) {
  const auto limit = static_cast<float>(radius * radius / (grid.spacing * grid.spacing));
  const std::vector<float> out = squared_voxel_distance(grid.size, grid.is_solid);
  std::vector<std::uint8_t> air(out.size());
  for (std::size_t i = 0; i < air.size(); ++i) air[i] = out[i] > limit ? 1 : 0;
  const std::vector<float> back = squared_voxel_distance(grid.size, air);
  for (std::size_t i = 0; i < air.size(); ++i) {
    if (back[i] > limit) grid.is_solid[i] = 1;
  }
}

// Marks what air reaches from the border, slice by slice across `axis` (within the slice only), or
// throughout the grid if `axis` is 3.
std::vector<std::uint8_t> open_air(const SolidGrid& grid, int axis) {
  std::vector<std::uint8_t> is_open(grid.is_solid.size(), 0);
  const std::array<int, 3> stride = {1, grid.size[0], grid.size[0] * grid.size[1]};
  std::vector<int> stack;
  const auto visit = [&](int n) {
    if (grid.is_solid[n] != 0 || is_open[n] != 0) return;
    is_open[n] = 1;
    stack.push_back(n);
  };
  for (int k = 0; k < grid.size[2]; ++k) {
    for (int j = 0; j < grid.size[1]; ++j) {
      for (int i = 0; i < grid.size[0]; ++i) {
        const std::array<int, 3> at = {i, j, k};
        bool is_border = false;
        for (int a = 0; a < 3; ++a) {
          if (a != axis) is_border = is_border || at[a] == 0 || at[a] == grid.size[a] - 1;
        }
        if (is_border) visit(static_cast<int>(grid.index(i, j, k)));
      }
    }
  }
  while (!stack.empty()) {
    const int n = stack.back();
    stack.pop_back();
    const std::array<int, 3> at = grid.voxel(n);
    for (int a = 0; a < 3; ++a) {
      if (a == axis) continue;
      if (at[a] > 0) visit(n - stride[a]);
      if (at[a] + 1 < grid.size[a]) visit(n + stride[a]);
    }
  }
  return is_open;
}

void fill_voids(SolidGrid& grid) {
  const std::vector<std::uint8_t> is_open = open_air(grid, 3);
  for (std::size_t i = 0; i < is_open.size(); ++i) {
    if (is_open[i] == 0) grid.is_solid[i] = 1;
  }
}

// Fills what slices across an axis enclose, piece by piece, if it is a pocket.
void fill_pockets(int axis, SolidGrid& grid) {
  const std::vector<std::uint8_t> is_open = open_air(grid, axis);
  std::vector<std::uint8_t> is_seen(is_open.size(), 0);
  const std::array<int, 3> stride = {1, grid.size[0], grid.size[0] * grid.size[1]};
  std::vector<int> piece;
  std::vector<int> fill;
  for (std::size_t start = 0; start < is_open.size(); ++start) {
    if (grid.is_solid[start] != 0 || is_open[start] != 0 || is_seen[start] != 0) continue;
    piece.assign(1, static_cast<int>(start));
    is_seen[start] = 1;
    long walls = 0;
    std::array<long, 2> mouths = {0, 0};  // towards either end of the axis
    for (std::size_t next = 0; next < piece.size(); ++next) {
      const int n = piece[next];
      for (const int s : stride) {
        for (const int m : {n - s, n + s}) {
          if (grid.is_solid[m] != 0) {
            ++walls;
          } else if (is_open[m] != 0) {  // in another slice: its own slice encloses the piece
            ++mouths[m < n ? 0 : 1];
          } else if (is_seen[m] == 0) {
            is_seen[m] = 1;
            piece.push_back(m);
          }
        }
      }
    }
    const auto [smaller, larger] = std::minmax(mouths[0], mouths[1]);
    const auto mouth = static_cast<double>(mouths[0] + mouths[1]);
    if (mouth <= kLargestMouth * (mouth + static_cast<double>(walls)) ||
        static_cast<double>(smaller) <= kFloorLeak * static_cast<double>(larger)) {
      fill.insert(fill.end(), piece.begin(), piece.end());
    }
  }
  for (const int n : fill) grid.is_solid[n] = 1;
}

}  // namespace

Vec3 SolidGrid::centre(std::size_t index) const {
  const std::array<int, 3> at = voxel(index);
  Vec3 result;
  for (std::size_t a = 0; a < 3; ++a) result[a] = (at[a] - 0.5 * (size[a] - 1)) * spacing;
  return result;
}

double SolidGrid::depth_at(const Vec3& point) const {
  std::array<int, 3> low{};
  std::array<double, 3> share{};
  for (std::size_t a = 0; a < 3; ++a) {
    const double q = point[a] / spacing + 0.5 * (size[a] - 1);
    if (!(q >= 0.0) || q >= size[a] - 1) return 0.0;
    low[a] = static_cast<int>(q);
    share[a] = q - low[a];
  }
  double sum = 0.0;
  for (int c = 0; c < 8; ++c) {
    double weight = 1.0;
    std::array<int, 3> at = low;
    for (std::size_t a = 0; a < 3; ++a) {
      const int bit = (c >> a) & 1;
      at[a] += bit;
      weight *= bit != 0 ? share[a] : 1.0 - share[a];
    }
    sum += weight * depth[index(at[0], at[1], at[2])];
  }
  return sum;
}

SolidGrid make_solid_grid(const geometry::TriangleMesh& mesh, const SolidGridOptions& options) {
  SolidGrid grid;
  if (mesh.triangles.empty()) return grid;
  grid.product_from_grid = own_frame(mesh);
  std::vector<Vec3> x(mesh.vertices.size());
  Box3 box;
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] = grid.product_from_grid.to_grid(mesh.vertices[i]);
  for (const Triangle& t : mesh.triangles) {
    for (const int i : t) box.extend(x[i]);
  }
  const Vec3 middle = box.center();
  for (Vec3& p : x) p -= middle;
  grid.product_from_grid.origin = grid.product_from_grid * middle;
  const Vec3 extent = box.sizes() + Vec3::Constant(2.0 * options.closing);
  grid.spacing = std::max(options.finest, std::cbrt(extent.prod() / options.voxels));
  for (std::size_t a = 0; a < 3; ++a) {
    grid.size[a] = static_cast<int>(std::ceil(extent[a] / grid.spacing)) + 4;
  }
  const std::size_t count = static_cast<std::size_t>(grid.size[0]) * grid.size[1] * grid.size[2];
  std::vector<std::uint8_t> votes(count, 0);
  for (std::size_t a = 0; a < 3; ++a) vote_along(x, mesh.triangles, a, grid, votes);
  grid.is_solid.assign(count, 0);
  for (std::size_t i = 0; i < count; ++i) grid.is_solid[i] = votes[i] >= 2 ? 1 : 0;
  add_surface(x, mesh.triangles, grid);
  close_gaps(options.closing, grid);
  fill_voids(grid);
  for (int a = 0; a < 3; ++a) fill_pockets(a, grid);
  fill_voids(grid);
  std::vector<std::uint8_t> air(count);
  for (std::size_t i = 0; i < count; ++i) air[i] = grid.is_solid[i] != 0 ? 0 : 1;
  const std::vector<float> squared = squared_voxel_distance(grid.size, air);
  grid.depth.assign(count, 0.0F);
  // The surface runs half a voxel before the first centre in air, and about a quarter of a voxel
  // inside of the voxels that it was drawn with.
  for (std::size_t i = 0; i < count; ++i) {
    if (grid.is_solid[i] != 0) {
      grid.depth[i] =
          static_cast<float>(std::max(0.25, std::sqrt(squared[i]) - 0.75) * grid.spacing);
    }
  }
  grid.air = squared_voxel_distance(grid.size, grid.is_solid);
  for (float& d : grid.air) d = static_cast<float>(std::sqrt(d) * grid.spacing);
  return grid;
}

}  // namespace palmar::product
