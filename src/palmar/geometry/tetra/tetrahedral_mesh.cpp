// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/tetra/tetrahedral_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <utility>

namespace palmar::geometry {
namespace {

/// The faces opposite the corners, each counter-clockwise seen from outside.
constexpr std::array<std::array<int, 3>, 4> kFaces = {{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

struct TriangleHash {
  std::size_t operator()(const Triangle& t) const {
    std::uint64_t h = 0xcbf29ce484222325ULL;
    for (const int v : t) h = (h ^ static_cast<std::uint64_t>(v)) * 0x100000001b3ULL;
    return static_cast<std::size_t>(h ^ (h >> 29));
  }
};

std::uint64_t edge_key(int a, int b) {
  const auto [low, high] = std::minmax(a, b);
  return (static_cast<std::uint64_t>(low) << 32) | static_cast<std::uint32_t>(high);
}

/// Cuts tetrahedra by the signs of their corners.
class Clipper {
 public:
  Clipper(TetrahedralMesh& mesh, std::vector<double> value, std::vector<char>& is_on)
      : mesh_(mesh), value_(std::move(value)), is_on_(is_on) {}

  void run(const TetrahedralMesh& source) {
    for (const Tetrahedron& t : source.tetrahedra) clip(t);
  }
  const std::vector<int>& new_vertices() const { return new_; }
  /// The ends of the edges on which they are, in the same order.
  const std::vector<std::pair<int, int>>& cut_edges() const { return cut_edge_; }

 private:
  void add(int a, int b, int c, int d) {
    const auto& x = mesh_.vertices;
    const double v = tetrahedron_volume(x[a], x[b], x[c], x[d]);
    if (v == 0.0) return;
    if (v > 0.0) {
      mesh_.tetrahedra.push_back({a, b, c, d});
    } else {
      mesh_.tetrahedra.push_back({a, b, d, c});
    }
  }
  /// Where the edge between an inner and an outer vertex crosses the surface.
  int cut(int inner, int outer) {
    const auto [place, is_new] = cut_.try_emplace(edge_key(inner, outer), -1);
    if (is_new) {
      const double share = value_[inner] / (value_[inner] - value_[outer]);
      place->second = mesh_.vertex_count();
      mesh_.vertices.emplace_back((1.0 - share) * mesh_.vertices[inner] +
                                  share * mesh_.vertices[outer]);
      value_.push_back(0.0);
      is_on_.push_back(1);
      new_.push_back(place->second);
      cut_edge_.emplace_back(inner, outer);
    }
    return place->second;
  }
  /// Quadrilateral a b c d (in this order round it) under the apex.
  void pyramid(int a, int b, int c, int d, int apex) {
    if (std::min(a, c) < std::min(b, d)) {
      add(a, b, c, apex);
      add(a, c, d, apex);
    } else {
      add(a, b, d, apex);
      add(b, c, d, apex);
    }
  }
  /// Between the triangles p[0..2] and p[3..5], p[k] above p[k + 3].
  void prism(std::array<int, 6> p) {
    const auto least = static_cast<int>(std::min_element(p.begin(), p.end()) - p.begin());
    if (least >= 3) p = {p[3], p[4], p[5], p[0], p[1], p[2]};
    const int turn = least % 3;
    std::array<int, 6> q{};
    for (int k = 0; k < 3; ++k) {
      q[k] = p[(k + turn) % 3];
      q[k + 3] = p[(k + turn) % 3 + 3];
    }
    // The two quadrilaterals at q[0] are split there; the third at its least vertex.
    add(q[0], q[3], q[4], q[5]);
    if (std::min(q[1], q[5]) < std::min(q[2], q[4])) {
      add(q[0], q[1], q[2], q[5]);
      add(q[0], q[1], q[5], q[4]);
    } else {
      add(q[0], q[1], q[2], q[4]);
      add(q[0], q[4], q[2], q[5]);
    }
  }

  void clip(const Tetrahedron& t) {
    std::array<int, 4> in{}, on{}, out{};
    int ins = 0, ons = 0, outs = 0;
    for (const int v : t) {
      if (value_[v] < 0.0) {
        in[ins++] = v;
      } else if (value_[v] > 0.0) {
        out[outs++] = v;
      } else {
        on[ons++] = v;
      }
    }
    if (ins == 0) return;
    if (outs == 0) {
      mesh_.tetrahedra.push_back(t);
    } else if (ins == 1) {
      std::array<int, 3> other{};
      for (int k = 0; k < ons; ++k) other[k] = on[k];
      for (int k = 0; k < outs; ++k) other[ons + k] = cut(in[0], out[k]);
      add(in[0], other[0], other[1], other[2]);
    } else if (ins == 3) {
      prism({in[0], in[1], in[2], cut(in[0], out[0]), cut(in[1], out[0]), cut(in[2], out[0])});
    } else if (outs == 2) {
      prism({in[0], cut(in[0], out[0]), cut(in[0], out[1]), in[1], cut(in[1], out[0]),
             cut(in[1], out[1])});
    } else {
      // One after the other: a cut makes a vertex, and compilers differ in the order of arguments.
      const int first = cut(in[0], out[0]), second = cut(in[1], out[0]);
      pyramid(in[0], in[1], second, first, on[0]);
    }
  }

  TetrahedralMesh& mesh_;
  std::vector<double> value_;
  std::vector<char>& is_on_;
  std::unordered_map<std::uint64_t, int> cut_;
  std::vector<int> new_;
  std::vector<std::pair<int, int>> cut_edge_;
};

std::vector<double> shortest_edges(const TetrahedralMesh& mesh) {
  std::vector<double> result(mesh.vertices.size(), std::numeric_limits<double>::infinity());
  for (const Tetrahedron& t : mesh.tetrahedra) {
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        const double length = (mesh.vertices[t[a]] - mesh.vertices[t[b]]).norm();
        result[t[a]] = std::min(result[t[a]], length);
        result[t[b]] = std::min(result[t[b]], length);
      }
    }
  }
  return result;
}

}  // namespace

double tetrahedron_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return (b - a).cross(c - a).dot(d - a) / 6.0;
}

double volume(const TetrahedralMesh& mesh) {
  double sum = 0.0;
  for (const Tetrahedron& t : mesh.tetrahedra) {
    sum += tetrahedron_volume(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]],
                              mesh.vertices[t[3]]);
  }
  return sum;
}

std::vector<double> smallest_dihedral_angles(const TetrahedralMesh& mesh) {
  std::vector<double> result;
  result.reserve(mesh.tetrahedra.size());
  for (const Tetrahedron& t : mesh.tetrahedra) {
    std::array<Vec3, 4> normal;
    for (std::size_t f = 0; f < 4; ++f) {
      const Vec3& a = mesh.vertices[t[kFaces[f][0]]];
      normal[f] = (mesh.vertices[t[kFaces[f][1]]] - a)
                      .cross(mesh.vertices[t[kFaces[f][2]]] - a)
                      .normalized();
    }
    double cosine = -1.0;
    for (std::size_t f = 0; f < 4; ++f) {
      for (std::size_t g = 0; g < f; ++g) cosine = std::max(cosine, -normal[f].dot(normal[g]));
    }
    result.push_back(std::acos(std::clamp(cosine, -1.0, 1.0)));
  }
  return result;
}

std::vector<Triangle> boundary_faces(const TetrahedralMesh& mesh) {
  std::unordered_map<Triangle, int, TriangleHash> uses;
  uses.reserve(2 * mesh.tetrahedra.size());
  const auto face_of = [](const Tetrahedron& t, const std::array<int, 3>& f) {
    return Triangle{t[f[0]], t[f[1]], t[f[2]]};
  };
  for (const Tetrahedron& t : mesh.tetrahedra) {
    for (const auto& f : kFaces) ++uses[sorted(face_of(t, f))];
  }
  std::vector<Triangle> result;
  for (const Tetrahedron& t : mesh.tetrahedra) {
    for (const auto& f : kFaces) {
      const Triangle face = face_of(t, f);
      if (uses[sorted(face)] == 1) result.push_back(face);
    }
  }
  return result;
}

TetrahedralMesh without_unused(const TetrahedralMesh& mesh, std::vector<int>* kept) {
  TetrahedralMesh result;
  std::vector<int> index(mesh.vertices.size(), -1);
  for (const Tetrahedron& t : mesh.tetrahedra) {
    for (const int v : t) index[v] = 0;
  }
  if (kept != nullptr) kept->clear();
  for (std::size_t v = 0; v < index.size(); ++v) {
    if (index[v] < 0) continue;
    index[v] = result.vertex_count();
    result.vertices.push_back(mesh.vertices[v]);
    if (kept != nullptr) kept->push_back(static_cast<int>(v));
  }
  result.tetrahedra.reserve(mesh.tetrahedra.size());
  for (const Tetrahedron& t : mesh.tetrahedra) {
    result.tetrahedra.push_back({index[t[0]], index[t[1]], index[t[2]], index[t[3]]});
  }
  return result;
}

ClippedMesh clip_tetrahedra(const TetrahedralMesh& mesh, const ClipSurface& surface, double snap,
                            const std::vector<char>& is_held) {
  ClippedMesh result;
  result.mesh.vertices = mesh.vertices;
  std::vector<char> is_on(mesh.vertices.size(), 0);
  std::vector<double> value(mesh.vertices.size());
  const std::vector<ClipSample> sample = surface(mesh.vertices);
  std::vector<double> near = shortest_edges(mesh);
  for (double& edge : near) edge *= snap;
  for (std::size_t v = 0; v < value.size(); ++v) {
    value[v] = sample[v].value;
    if (std::abs(value[v]) >= near[v] || (!is_held.empty() && is_held[v])) continue;
    result.mesh.vertices[v] = sample[v].closest;
    value[v] = 0.0;
    is_on[v] = 1;
  }
  // A tetrahedron that moving its corners has turned inside out would stay so: its corners go back.
  for (bool is_clean = false; !is_clean;) {
    is_clean = true;
    for (const Tetrahedron& t : mesh.tetrahedra) {
      const auto& x = result.mesh.vertices;
      const auto& y = mesh.vertices;
      const double least = 0.05 * tetrahedron_volume(y[t[0]], y[t[1]], y[t[2]], y[t[3]]);
      if (tetrahedron_volume(x[t[0]], x[t[1]], x[t[2]], x[t[3]]) >= least) continue;
      for (const int v : t) {
        if (!is_on[v]) continue;
        is_on[v] = 0;
        result.mesh.vertices[v] = mesh.vertices[v];
        // Off the surface by rounding at least, so that it has a side.
        value[v] = sample[v].value != 0.0 ? sample[v].value : -1e-12;
        is_clean = false;
      }
    }
  }
  Clipper clipper(result.mesh, value, is_on);
  clipper.run(mesh);
  // Interpolation along an edge leaves the cuts a little off a curved surface.
  std::vector<Vec3> cut;
  for (const int v : clipper.new_vertices()) cut.push_back(result.mesh.vertices[v]);
  const std::vector<ClipSample> at_cut = surface(cut);
  for (std::size_t k = 0; k < cut.size(); ++k) {
    const auto [inner, outer] = clipper.cut_edges()[k];
    if (std::abs(at_cut[k].value) < std::min(near[inner], near[outer])) {
      result.mesh.vertices[clipper.new_vertices()[k]] = at_cut[k].closest;
    }
  }
  std::erase_if(result.mesh.tetrahedra, [&](const Tetrahedron& t) {
    const auto& x = result.mesh.vertices;
    const double longest = std::max({(x[t[1]] - x[t[0]]).norm(), (x[t[2]] - x[t[0]]).norm(),
                                     (x[t[3]] - x[t[0]]).norm(), (x[t[2]] - x[t[1]]).norm()});
    return tetrahedron_volume(x[t[0]], x[t[1]], x[t[2]], x[t[3]]) <
           1e-4 * longest * longest * longest;
  });
  std::vector<int> kept;
  result.mesh = without_unused(result.mesh, &kept);
  for (const int v : kept) {
    result.is_on_surface.push_back(is_on[v]);
    result.origin.push_back(v < mesh.vertex_count() ? v : -1);
  }
  return result;
}

}  // namespace palmar::geometry
