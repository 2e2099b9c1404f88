// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/mesh/primitive_meshes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <sstream>
#include <utility>

#include "palmar/core/error.h"

namespace palmar::geometry {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

void require_length(const char* shape, const char* name, double value) {
  if (std::isfinite(value) && value > 0.0) return;
  std::ostringstream message;
  message << shape << ": " << name << " is " << value
          << " mm; a positive, finite length is required";
  throw UsageError(message.str());
}

void require_count(const char* shape, const char* name, int value, int lowest, int highest) {
  if (value >= lowest && value <= highest) return;
  std::ostringstream message;
  message << shape << ": " << name << " is " << value << "; allowed are " << lowest << " to "
          << highest;
  throw UsageError(message.str());
}

constexpr int kMaxCount = 10000;

// Point on a circle about z; whole quarter turns are exact, so that symmetric shapes are.
Vec3 on_circle(double radius, int step, int steps, double z) {
  const double angle = kTwoPi * step / steps;
  double c = std::cos(angle), s = std::sin(angle);
  if ((4 * step) % steps == 0) {
    c = std::round(c);
    s = std::round(s);
  }
  return {radius * c, radius * s, z};
}

TriangleMesh split_in_four(const TriangleMesh& mesh) {
  TriangleMesh result;
  result.vertices = mesh.vertices;
  std::map<std::pair<int, int>, int> midpoints;
  const auto midpoint = [&](int a, int b) {
    const auto [place, is_new] =
        midpoints.try_emplace(std::minmax(a, b), static_cast<int>(result.vertices.size()));
    if (is_new) {
      result.vertices.push_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
    }
    return place->second;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    const int ab = midpoint(a, b), bc = midpoint(b, c), ca = midpoint(c, a);
    for (const Triangle& t :
         {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c}, Triangle{ab, bc, ca}}) {
      result.triangles.push_back(t);
    }
  }
  return result;
}

// Joins two rings of n vertices starting at `lower` and `upper`; outside is to the right of the
// direction of growing index when looking from lower to upper.
void join_rings(int lower, int upper, int n, std::vector<Triangle>& triangles) {
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    triangles.push_back({lower + i, lower + j, upper + j});
    triangles.push_back({lower + i, upper + j, upper + i});
  }
}

// Disc at height z whose rim is the ring of n vertices from `rim` on.
void add_cap(const CylinderOptions& o, int rim, double z, bool faces_up, TriangleMesh& mesh) {
  const int n = o.segments;
  const int inner_rings = std::max(1, static_cast<int>(std::lround(n / kTwoPi))) - 1;
  std::vector<Triangle> triangles;
  int outer = rim, outer_count = n;
  for (int k = inner_rings; k >= 1; --k) {
    const double radius = o.radius * k / (inner_rings + 1);
    const int count = std::max(3, static_cast<int>(std::lround(n * radius / o.radius)));
    const int inner = mesh.vertex_count();
    for (int i = 0; i < count; ++i) mesh.vertices.push_back(on_circle(radius, i, count, z));
    // Walk round both rings, always advancing on the one that lags behind in angle.
    int i = 0, j = 0;
    while (i < outer_count || j < count) {
      const bool advance_outer =
          j == count || (i < outer_count && static_cast<long>(2 * i + 1) * count <=
                                                static_cast<long>(2 * j + 1) * outer_count);
      const int a = outer + i % outer_count, b = inner + j % count;
      if (advance_outer) {
        triangles.push_back({a, outer + (i + 1) % outer_count, b});
        ++i;
      } else {
        triangles.push_back({a, inner + (j + 1) % count, b});
        ++j;
      }
    }
    outer = inner;
    outer_count = count;
  }
  const int centre = mesh.vertex_count();
  mesh.vertices.emplace_back(0.0, 0.0, z);
  for (int i = 0; i < outer_count; ++i) {
    triangles.push_back({outer + i, outer + (i + 1) % outer_count, centre});
  }
  for (Triangle t : triangles) {
    if (!faces_up) std::swap(t[1], t[2]);
    mesh.triangles.push_back(t);
  }
}

}  // namespace

TriangleMesh make_icosphere(double radius, int subdivisions) {
  require_length("icosphere", "radius", radius);
  require_count("icosphere", "subdivisions", subdivisions, 0, 8);
  const double g = std::numbers::phi;
  TriangleMesh mesh;
  mesh.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                    {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                    {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                    {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (int level = 0; level < subdivisions; ++level) {
    mesh = split_in_four(mesh);
    for (Vec3& v : mesh.vertices) v.normalize();
  }
  for (Vec3& v : mesh.vertices) v *= radius / v.norm();
  return mesh;
}

TriangleMesh make_box(const Vec3& size, int divisions) {
  require_length("box", "size x", size.x());
  require_length("box", "size y", size.y());
  require_length("box", "size z", size.z());
  require_count("box", "divisions", divisions, 1, 1000);
  TriangleMesh mesh;
  std::map<std::array<int, 3>, int> index_of;
  const auto vertex = [&](const std::array<int, 3>& place) {
    const auto [entry, is_new] = index_of.try_emplace(place, mesh.vertex_count());
    if (is_new) {
      Vec3 p;
      for (int k = 0; k < 3; ++k) {
        p[k] = size[k] * (static_cast<double>(place[k]) / divisions - 0.5);
      }
      mesh.vertices.push_back(p);
    }
    return entry->second;
  };
  for (size_t axis = 0; axis < 3; ++axis) {
    const size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const int side : {0, divisions}) {
      for (int j = 0; j < divisions; ++j) {
        for (int i = 0; i < divisions; ++i) {
          std::array<int, 3> p{};
          p[axis] = side;
          const auto at = [&](int du, int dv) {
            p[u] = i + du;
            p[v] = j + dv;
            return vertex(p);
          };
          const int a = at(0, 0), b = at(1, 0), c = at(1, 1), d = at(0, 1);
          if (side == 0) {
            mesh.triangles.push_back({a, c, b});
            mesh.triangles.push_back({a, d, c});
          } else {
            mesh.triangles.push_back({a, b, c});
            mesh.triangles.push_back({a, c, d});
          }
        }
      }
    }
  }
  return mesh;
}

TriangleMesh make_grid_patch(int columns, int rows, double spacing) {
  require_count("grid patch", "columns", columns, 1, kMaxCount);
  require_count("grid patch", "rows", rows, 1, kMaxCount);
  require_length("grid patch", "spacing", spacing);
  TriangleMesh mesh;
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) mesh.vertices.emplace_back(i * spacing, j * spacing, 0.0);
  }
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const int a = j * (columns + 1) + i, b = a + 1, d = a + columns + 1, c = d + 1;
      if ((i + j) % 2 == 0) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
      } else {
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({b, c, d});
      }
    }
  }
  return mesh;
}

TriangleMesh make_lattice_patch(double radius, double spacing) {
  require_length("lattice patch", "radius", radius);
  require_length("lattice patch", "spacing", spacing);
  if (spacing > radius || radius / spacing > 2000.0) {
    std::ostringstream message;
    message << "lattice patch: spacing is " << spacing << " mm; allowed are " << radius / 2000.0
            << " mm to the radius, " << radius << " mm";
    throw UsageError(message.str());
  }
  const int reach = static_cast<int>(std::ceil(2.0 * radius / spacing)) + 1;
  // Squared distance in units of spacing^2 is the integer i^2 + ij + j^2; the small allowance lets
  // a radius that is a multiple of the spacing include its corners.
  const double limit = (radius / spacing) * (radius / spacing) * (1.0 + 1e-9);
  const auto is_inside = [&](int i, int j) {
    return static_cast<double>(i) * i + static_cast<double>(i) * j + static_cast<double>(j) * j <=
           limit;
  };
  const auto is_triangle = [&](int i, int j, bool points_up) {
    return is_inside(i + 1, j) && is_inside(i, j + 1) &&
           (points_up ? is_inside(i, j) : is_inside(i + 1, j + 1));
  };
  TriangleMesh mesh;
  mesh.vertices.push_back(Vec3::Zero());
  std::map<std::pair<int, int>, int> index_of{{{0, 0}, 0}};
  for (int j = -reach; j <= reach; ++j) {
    for (int i = -reach; i <= reach; ++i) {
      // Only vertices that a triangle uses.
      const bool is_used = is_triangle(i, j, true) || is_triangle(i - 1, j, true) ||
                           is_triangle(i, j - 1, true) || is_triangle(i - 1, j, false) ||
                           is_triangle(i, j - 1, false) || is_triangle(i - 1, j - 1, false);
      if (!is_used || (i == 0 && j == 0)) continue;
      index_of[{i, j}] = mesh.vertex_count();
      mesh.vertices.emplace_back(spacing * (i + 0.5 * j), spacing * j * std::sqrt(0.75), 0.0);
    }
  }
  for (int j = -reach; j <= reach; ++j) {
    for (int i = -reach; i <= reach; ++i) {
      if (is_triangle(i, j, true)) {
        mesh.triangles.push_back(
            {index_of.at({i, j}), index_of.at({i + 1, j}), index_of.at({i, j + 1})});
      }
      if (is_triangle(i, j, false)) {
        mesh.triangles.push_back(
            {index_of.at({i + 1, j}), index_of.at({i + 1, j + 1}), index_of.at({i, j + 1})});
      }
    }
  }
  return mesh;
}

void CylinderOptions::check() const {
  require_length("cylinder", "radius", radius);
  require_length("cylinder", "length", length);
  require_count("cylinder", "segments", segments, 3, kMaxCount);
  require_count("cylinder", "rings", rings, 1, kMaxCount);
}

TriangleMesh make_cylinder(const CylinderOptions& options) {
  options.check();
  const int n = options.segments;
  TriangleMesh mesh;
  for (int k = 0; k <= options.rings; ++k) {
    const double z = options.length * (static_cast<double>(k) / options.rings - 0.5);
    for (int i = 0; i < n; ++i) mesh.vertices.push_back(on_circle(options.radius, i, n, z));
  }
  for (int k = 0; k < options.rings; ++k) join_rings(k * n, (k + 1) * n, n, mesh.triangles);
  if (options.is_capped) {
    add_cap(options, 0, -0.5 * options.length, false, mesh);
    add_cap(options, options.rings * n, 0.5 * options.length, true, mesh);
  }
  return mesh;
}

TriangleMesh make_torus(double major_radius, double minor_radius, int major_segments,
                        int minor_segments) {
  require_length("torus", "major radius", major_radius);
  require_length("torus", "minor radius", minor_radius);
  require_count("torus", "major segments", major_segments, 3, kMaxCount);
  require_count("torus", "minor segments", minor_segments, 3, kMaxCount);
  if (minor_radius >= major_radius) {
    std::ostringstream message;
    message << "torus: minor radius is " << minor_radius
            << " mm; it must be smaller than the major radius, " << major_radius << " mm";
    throw UsageError(message.str());
  }
  TriangleMesh mesh;
  for (int i = 0; i < major_segments; ++i) {
    for (int j = 0; j < minor_segments; ++j) {
      const Vec3 tube = on_circle(minor_radius, j, minor_segments, 0.0);
      mesh.vertices.push_back(on_circle(major_radius + tube.x(), i, major_segments, tube.y()));
    }
  }
  for (int i = 0; i < major_segments; ++i) {
    for (int j = 0; j < minor_segments; ++j) {
      const int i1 = (i + 1) % major_segments, j1 = (j + 1) % minor_segments;
      const int a = i * minor_segments + j, b = i1 * minor_segments + j;
      const int c = i1 * minor_segments + j1, d = i * minor_segments + j1;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

}  // namespace palmar::geometry
