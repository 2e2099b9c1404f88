// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "solid_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <unordered_map>

namespace palmar::tests {
namespace {

double outline_distance(const std::vector<Vec2>& outline, const Vec2& p) {
  double least = 1e18;
  bool is_inside = false;
  for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
    const Vec2 &a = outline[i], &b = outline[j];
    const Vec2 ab = b - a;
    const double t = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (p - a - t * ab).norm());
    if ((a.y() > p.y()) != (b.y() > p.y()) &&
        p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) {
      is_inside = !is_inside;
    }
  }
  return is_inside ? -least : least;
}

std::vector<double> planes_of(const Lattice& lattice, int axis, double refinement) {
  std::vector<double> planes;
  // Odd shares keep planes off the shapes' own faces.
  double at = lattice.box.min()[axis] - 1.37 * lattice.usual[axis] / refinement;
  const double end = lattice.box.max()[axis] + 1.37 * lattice.usual[axis] / refinement;
  while (true) {
    planes.push_back(at);
    if (at > end) return planes;
    double step = lattice.usual[axis];
    for (const Lattice::Layer& layer : lattice.layers) {
      if (layer.axis == axis && at >= layer.from - layer.step && at < layer.to) step = layer.step;
    }
    at += step / refinement;
  }
}

// The 12 edges of a cell as pairs of its corners; bit a of a corner: upper along axis a.
constexpr std::array<std::array<int, 2>, 12> kCellEdges = {{{0, 1},
                                                            {2, 3},
                                                            {4, 5},
                                                            {6, 7},
                                                            {0, 2},
                                                            {1, 3},
                                                            {4, 6},
                                                            {5, 7},
                                                            {0, 4},
                                                            {1, 5},
                                                            {2, 6},
                                                            {3, 7}}};

// The sheet of the surface that each edge of a cell crosses: the same number for edges that the
// surface joins within the cell's faces; -1 where an edge doesn't cross it. Where all four edges of
// a face cross it, the two that meet in an inner corner belong together; both cells that share the
// face see it so, and the mesh is closed.
std::array<int, 12> sheet_of_edges(const std::array<bool, 8>& is_inside) {
  std::array<int, 12> sheet{};
  for (int e = 0; e < 12; ++e) {
    sheet[e] = is_inside[kCellEdges[e][0]] != is_inside[kCellEdges[e][1]] ? e : -1;
  }
  const auto join = [&](int a, int b) {
    const int kept = std::min(sheet[a], sheet[b]), gone = std::max(sheet[a], sheet[b]);
    for (int& s : sheet) s = s == gone ? kept : s;
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 2; ++side) {
      std::vector<int> crossed;
      for (int e = 0; e < 12; ++e) {
        const bool is_on_face =
            ((kCellEdges[e][0] >> axis) & 1) == side && ((kCellEdges[e][1] >> axis) & 1) == side;
        if (is_on_face && sheet[e] >= 0) crossed.push_back(e);
      }
      if (crossed.size() == 2) join(crossed[0], crossed[1]);
      if (crossed.size() != 4) continue;
      const auto inner = [&](int e) {
        return is_inside[kCellEdges[e][0]] ? kCellEdges[e][0] : kCellEdges[e][1];
      };
      for (std::size_t k = 0; k < 4; ++k) {
        for (std::size_t l = 0; l < k; ++l) {
          if (inner(crossed[k]) == inner(crossed[l])) join(crossed[k], crossed[l]);
        }
      }
    }
  }
  return sheet;
}

Vec3 crossing(const product::Sdf& sdf, Vec3 in, Vec3 out, double value_in, double value_out) {
  for (int i = 0; i < 4; ++i) {
    const double t = std::clamp(value_in / (value_in - value_out), 0.05, 0.95);
    const Vec3 p = in + t * (out - in);
    const double value = sdf(p);
    (value < 0.0 ? in : out) = p;
    (value < 0.0 ? value_in : value_out) = value;
  }
  const double t = value_in / (value_in - value_out);
  return in + t * (out - in);
}

// Towards the surface along the gradient, at most `most`.
Vec3 on_surface(const product::Sdf& sdf, const Vec3& start, double most) {
  Vec3 p = start;
  for (int i = 0; i < 3; ++i) {
    const double value = sdf(p), h = 1e-4;
    Vec3 gradient;
    for (int a = 0; a < 3; ++a) {
      gradient[a] = (sdf(p + h * Vec3::Unit(a)) - sdf(p - h * Vec3::Unit(a))) / (2.0 * h);
    }
    if (gradient.squaredNorm() < 1e-4) break;
    const Vec3 next = p - value / gradient.squaredNorm() * gradient;
    if ((next - start).norm() > most) break;
    p = next;
  }
  return p;
}

}  // namespace

product::Sdf sdf_rounded_box(const Vec3& middle, const Vec3& size, double radius) {
  return [=](const Vec3& p) {
    const Vec3 d = (p - middle).cwiseAbs() - 0.5 * size + Vec3::Constant(radius);
    return d.cwiseMax(0.0).norm() + std::min(d.maxCoeff(), 0.0) - radius;
  };
}

product::Sdf sdf_lathe(std::vector<Vec2> outline, double rounding) {
  for (Vec2& p : outline) {
    if (p.x() <= 0.0) p.x() = -100.0;  // the axis is no surface
  }
  return [outline = std::move(outline), rounding](const Vec3& p) {
    return outline_distance(outline, {std::hypot(p.x(), p.y()), p.z()}) - rounding;
  };
}

product::Sdf sdf_extruded(std::vector<Vec2> outline, int u, int v, double low, double high) {
  return [=, outline = std::move(outline)](const Vec3& p) {
    const double across = p[3 - u - v];
    return std::max({outline_distance(outline, {p[u], p[v]}), low - across, across - high});
  };
}

product::Sdf sdf_bar(std::vector<Vec3> line, std::vector<double> radius) {
  return [line = std::move(line), radius = std::move(radius)](const Vec3& p) {
    double least = 1e18;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      const Vec3 a = line[i], ab = line[i + 1] - a;
      const double t = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
      const double r = radius[i] + t * (radius[i + 1] - radius[i]);
      least = std::min(least, (p - a - t * ab).norm() - r);
    }
    return least;
  };
}

product::Sdf sdf_stretched(const product::Sdf& shape, int axis, double factor) {
  return [=](Vec3 p) {
    p[axis] /= factor;
    return shape(p);
  };
}

product::Sdf sdf_blended(const product::Sdf& a, const product::Sdf& b, double radius) {
  return [=](const Vec3& p) {
    const double da = a(p), db = b(p);
    const double h = std::max(radius - std::abs(da - db), 0.0) / radius;
    return std::min(da, db) - 0.25 * h * h * radius;
  };
}

product::Sdf sdf_common(const product::Sdf& a, const product::Sdf& b) {
  return [=](const Vec3& p) { return std::max(a(p), b(p)); };
}

std::vector<Vec3> curve_through(const std::vector<Vec3>& points, int pieces) {
  std::vector<Vec3> line;
  const int last = static_cast<int>(points.size()) - 1;
  for (int i = 0; i < last; ++i) {
    const Vec3 &b = points[i], &c = points[i + 1];
    const Vec3 a = i > 0 ? points[i - 1] : Vec3(2.0 * b - c);
    const Vec3 d = i + 1 < last ? points[i + 2] : Vec3(2.0 * c - b);
    for (int k = 0; k < pieces; ++k) {
      const double t = static_cast<double>(k) / pieces;
      line.push_back(0.5 * (2.0 * b + t * (c - a) + t * t * (2.0 * a - 5.0 * b + 4.0 * c - d) +
                            t * t * t * (3.0 * b - a - 3.0 * c + d)));
    }
  }
  line.push_back(points.back());
  return line;
}

std::vector<Vec3> ellipse(const Vec3& middle, double along_x, double along_y, int pieces) {
  std::vector<Vec3> line;
  for (int i = 0; i <= pieces; ++i) {
    const double t = 2.0 * std::numbers::pi * (i % pieces) / pieces;
    line.push_back(middle + Vec3(along_x * std::cos(t), along_y * std::sin(t), 0.0));
  }
  return line;
}

geometry::TriangleMesh net_mesh_of(const product::Sdf& sdf, const Lattice& lattice,
                                   double refinement) {
  std::array<std::vector<double>, 3> planes;
  std::array<int, 3> n{};
  for (int a = 0; a < 3; ++a) {
    planes[a] = planes_of(lattice, a, refinement);
    n[a] = static_cast<int>(planes[a].size());
  }
  const auto index = [&](const std::array<int, 3>& c) {
    return c[0] + n[0] * (c[1] + static_cast<std::size_t>(n[1]) * c[2]);
  };
  const auto point = [&](const std::array<int, 3>& c) {
    return Vec3(planes[0][c[0]], planes[1][c[1]], planes[2][c[2]]);
  };
  std::vector<double> value(static_cast<std::size_t>(n[0]) * n[1] * n[2]);
  for (int k = 0; k < n[2]; ++k) {
    for (int j = 0; j < n[1]; ++j) {
      for (int i = 0; i < n[0]; ++i) value[index({i, j, k})] = sdf(point({i, j, k}));
    }
  }

  geometry::TriangleMesh mesh;
  // Vertex of each cell's edges that cross the surface; -1: none.
  std::unordered_map<std::size_t, std::array<int, 12>> vertex_of;
  for (int k = 0; k + 1 < n[2]; ++k) {
    for (int j = 0; j + 1 < n[1]; ++j) {
      for (int i = 0; i + 1 < n[0]; ++i) {
        std::array<bool, 8> is_inside{};
        std::array<std::array<int, 3>, 8> corner{};
        int inside = 0;
        for (int c = 0; c < 8; ++c) {
          corner[c] = {i + (c & 1), j + ((c >> 1) & 1), k + ((c >> 2) & 1)};
          is_inside[c] = value[index(corner[c])] < 0.0;
          inside += is_inside[c] ? 1 : 0;
        }
        if (inside == 0 || inside == 8) continue;
        const std::array<int, 12> sheet = sheet_of_edges(is_inside);
        std::map<int, std::vector<int>> sheets;
        for (int e = 0; e < 12; ++e) {
          if (sheet[e] >= 0) sheets[sheet[e]].push_back(e);
        }
        std::array<int, 12> vertex;
        vertex.fill(-1);
        const double most =
            0.5 * (point(corner[7]) - point(corner[0])).minCoeff();  // of a cell's smallest side
        for (const auto& [number, edges] : sheets) {
          Vec3 mean = Vec3::Zero();
          for (const int e : edges) {
            auto [a, b] = kCellEdges[e];
            if (!is_inside[a]) std::swap(a, b);
            mean += crossing(sdf, point(corner[a]), point(corner[b]), value[index(corner[a])],
                             value[index(corner[b])]) /
                    static_cast<double>(edges.size());
            vertex[e] = mesh.vertex_count();
          }
          mesh.vertices.push_back(on_surface(sdf, mean, most));
        }
        vertex_of.emplace(index({i, j, k}), vertex);
      }
    }
  }

  // Round each lattice edge that crosses the surface: the four cells that share it.
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int k = 1; k + 1 < n[2]; ++k) {
      for (int j = 1; j + 1 < n[1]; ++j) {
        for (int i = 1; i + 1 < n[0]; ++i) {
          std::array<int, 3> low = {i, j, k}, high = low;
          ++high[axis];
          const bool is_low_inside = value[index(low)] < 0.0;
          if (is_low_inside == (value[index(high)] < 0.0)) continue;
          std::array<int, 4> around{};  // counter-clockwise about `axis`
          constexpr std::array<std::array<int, 2>, 4> kBack = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
          for (int q = 0; q < 4; ++q) {
            std::array<int, 3> cell = low;
            cell[u] -= kBack[q][0];
            cell[v] -= kBack[q][1];
            const int first = (kBack[q][0] << u) | (kBack[q][1] << v);
            for (int e = 0; e < 12; ++e) {
              if (kCellEdges[e][0] == first && kCellEdges[e][1] == (first | (1 << axis))) {
                around[q] = vertex_of.at(index(cell))[e];
              }
            }
          }
          if (!is_low_inside) std::swap(around[1], around[3]);
          const auto square = [&](int a, int b) {
            return (mesh.vertices[around[a]] - mesh.vertices[around[b]]).squaredNorm();
          };
          const int s = square(0, 2) <= square(1, 3) ? 0 : 1;  // along the shorter diagonal
          mesh.triangles.push_back({around[s], around[s + 1], around[(s + 2) % 4]});
          mesh.triangles.push_back({around[s], around[(s + 2) % 4], around[(s + 3) % 4]});
        }
      }
    }
  }
  return mesh;
}

}  // namespace palmar::tests
