// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/imaging/iso_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"

namespace palmar::imaging {
namespace {

// Corner c of a cell has offsets (c & 1, c >> 1 & 1, c >> 2 & 1). Edge e = 4 axis + r runs along
// `axis` from kEdgeFrom[e]; r counts the corners with offset 0 along that axis.
constexpr int edge_from(int axis, int r) {
  const int low = r & 1, high = (r >> 1) & 1;
  if (axis == 0) return low << 1 | high << 2;
  if (axis == 1) return low | high << 2;
  return low | high << 1;
}

int edge_between(int a, int b) {
  const int from = std::min(a, b);
  const int axis = (a ^ b) == 1 ? 0 : (a ^ b) == 2 ? 1 : 2;
  for (int r = 0; r < 4; ++r) {
    if (edge_from(axis, r) == from) return 4 * axis + r;
  }
  return -1;
}

/// Whether two edges lie on one face of the cell.
bool share_face(int e, int f) {
  int all_e = 7, all_f = 7, any_e = 0, any_f = 0;
  for (const auto& [edge, all, any] :
       {std::tuple(e, &all_e, &any_e), std::tuple(f, &all_f, &any_f)}) {
    const int from = edge_from(edge / 4, edge % 4), to = from | (1 << (edge / 4));
    *all = from & to;
    *any = from | to;
  }
  return (all_e & all_f) != 0 || (~any_e & ~any_f & 7) != 0;
}

/// How one case is triangulated: corners below 12 are edges of the cell, 12 + l is the centre of
/// loop l.
struct CellCase {
  std::vector<std::array<int, 3>> triangles;
  std::vector<std::vector<int>> centred;  ///< edges of the loops that have a centre
};

CellCase make_case(int inside) {
  // From each crossing to the next one of the polygon: over each face, from where its border (seen
  // from outside, counter-clockwise) enters the bright to where it leaves it.
  std::array<int, 12> next;
  next.fill(-1);
  for (int axis = 0; axis < 3; ++axis) {
    const int u = 1 << ((axis + 1) % 3), v = 1 << ((axis + 2) % 3);
    for (int side = 0; side < 2; ++side) {
      const int base = side << axis;
      std::array<int, 4> corner = {base, base | u, base | u | v, base | v};
      if (side == 0) std::swap(corner[1], corner[3]);
      for (std::size_t i = 0; i < 4; ++i) {
        const auto is_in = [&](std::size_t k) { return ((inside >> corner[k % 4]) & 1) != 0; };
        if (is_in(i) || !is_in(i + 1)) continue;
        std::size_t k = i + 1;
        while (is_in(k)) ++k;
        next[edge_between(corner[i], corner[(i + 1) % 4])] =
            edge_between(corner[(k - 1) % 4], corner[k % 4]);
      }
    }
  }
  CellCase made;
  std::array<bool, 12> is_done{};
  for (std::size_t start = 0; start < 12; ++start) {
    if (next[start] < 0 || is_done[start]) continue;
    std::vector<int> loop;
    for (int e = static_cast<int>(start); !is_done[e]; e = next[e]) {
      is_done[e] = true;
      loop.push_back(e);
    }
    const std::size_t n = loop.size();
    std::size_t apex = n;
    for (std::size_t a = 0; a < n && apex == n; ++a) {
      bool is_good = true;
      for (std::size_t k = 2; k + 1 < n; ++k) {
        is_good = is_good && !share_face(loop[a], loop[(a + k) % n]);
      }
      if (is_good) apex = a;
    }
    if (apex < n) {
      for (std::size_t k = 1; k + 1 < n; ++k) {
        made.triangles.push_back({loop[apex], loop[(apex + k) % n], loop[(apex + k + 1) % n]});
      }
    } else {
      const int centre = 12 + static_cast<int>(made.centred.size());
      for (std::size_t k = 0; k < n; ++k) {
        made.triangles.push_back({centre, loop[k], loop[(k + 1) % n]});
      }
      made.centred.push_back(loop);
    }
  }
  return made;
}

const std::array<CellCase, 256>& cases() {
  static const std::array<CellCase, 256> all = [] {
    std::array<CellCase, 256> made;
    for (int i = 0; i < 256; ++i) made[i] = make_case(i);
    return made;
  }();
  return all;
}

/// The image with one layer of dark nodes round it: node n of the padded grid is voxel n - 1.
struct PaddedImage {
  const Volume& image;
  double level;
  std::array<int, 3> size;

  explicit PaddedImage(const Volume& volume, double at) : image(volume), level(at), size{} {
    for (std::size_t a = 0; a < 3; ++a) size[a] = volume.grid.size[a] + 2;
  }
  bool is_padding(int i, int j, int k) const {
    return i == 0 || j == 0 || k == 0 || i == size[0] - 1 || j == size[1] - 1 || k == size[2] - 1;
  }
  float at(int i, int j, int k) const { return image.value[image.grid.at(i - 1, j - 1, k - 1)]; }
  bool is_inside(int i, int j, int k) const {
    return !is_padding(i, j, k) && static_cast<double>(at(i, j, k)) > level;
  }
  /// Share of the way from a node to the next one along `axis`, whose sides differ.
  double crossing(int i, int j, int k, int axis) const {
    const std::array<int, 3> to = {i + (axis == 0), j + (axis == 1), k + (axis == 2)};
    if (is_padding(i, j, k) || is_padding(to[0], to[1], to[2])) return 0.5;
    const double a = at(i, j, k), b = at(to[0], to[1], to[2]);
    // Kept off the nodes, so that no triangle loses its area altogether.
    return std::clamp((level - a) / (b - a), 1e-3, 1.0 - 1e-3);
  }
};

/// Vertices on the edges that start in one layer of nodes, and the triangles of the cells on it.
struct Layer {
  std::vector<unsigned char> is_inside;  ///< per node
  std::vector<int> vertex;               ///< 3 per node: index in `places`, -1
  std::vector<Vec3> places, centres;
  std::vector<std::array<int, 3>> triangles;  ///< see corner_code
};

}  // namespace

geometry::TriangleMesh iso_surface(const Volume& image, double level) {
  if (image.value.size() != image.grid.count() || image.grid.count() == 0) {
    throw UsageError("iso_surface: the image has another number of values than voxels, or none");
  }
  if (!std::isfinite(level)) throw UsageError("iso_surface: level must be a number");
  const PaddedImage padded(image, level);
  const auto [nx, ny, nz] = padded.size;
  const auto node = [nx = nx](int i, int j) {
    return static_cast<std::size_t>(i) + static_cast<std::size_t>(nx) * j;
  };
  std::vector<Layer> layers(nz);
  const std::size_t nodes = node(0, ny);
  parallel_for(nz, [&, nx = nx, ny = ny](int k) {
    Layer& layer = layers[k];
    layer.is_inside.resize(nodes);
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) layer.is_inside[node(i, j)] = padded.is_inside(i, j, k) ? 1 : 0;
    }
  });
  parallel_for(nz, [&, nx = nx, ny = ny, nz = nz](int k) {
    Layer& layer = layers[k];
    const Layer* above = k + 1 < nz ? &layers[k + 1] : nullptr;
    layer.vertex.assign(3 * nodes, -1);
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        const unsigned char here = layer.is_inside[node(i, j)];
        for (int axis = 0; axis < 3; ++axis) {
          if ((axis == 0 && i + 1 == nx) || (axis == 1 && j + 1 == ny) || (axis == 2 && !above)) {
            continue;
          }
          const unsigned char there = axis == 2
                                          ? above->is_inside[node(i, j)]
                                          : layer.is_inside[node(i + (axis == 0), j + (axis == 1))];
          if (here == there) continue;
          layer.vertex[3 * node(i, j) + static_cast<std::size_t>(axis)] =
              static_cast<int>(layer.places.size());
          Vec3 voxel(i - 1.0, j - 1.0, k - 1.0);
          voxel[axis] += padded.crossing(i, j, k, axis);
          layer.places.push_back(image.grid.to_patient(voxel));
        }
      }
    }
  });
  std::vector<int> first(static_cast<std::size_t>(nz) + 1, 0);
  for (std::size_t k = 0; k < layers.size(); ++k) {
    first[k + 1] = first[k] + static_cast<int>(layers[k].places.size());
  }
  parallel_for(nz - 1, [&, nx = nx, ny = ny](int k) {
    Layer& layer = layers[k];
    const auto place_of = [&](int i, int j, int edge) {
      const int from = edge_from(edge / 4, edge % 4);
      const auto on = k + (from >> 2);
      return first[on] + layers[on].vertex[3 * node(i + (from & 1), j + ((from >> 1) & 1)) +
                                           static_cast<std::size_t>(edge / 4)];
    };
    const auto coordinates = [&](int vertex) {
      const std::size_t on =
          vertex >= first[k + 1] ? static_cast<std::size_t>(k) + 1 : static_cast<std::size_t>(k);
      return layers[on].places[vertex - first[on]];
    };
    const Layer& above = layers[k + 1];
    for (int j = 0; j + 1 < ny; ++j) {
      for (int i = 0; i + 1 < nx; ++i) {
        unsigned inside = 0;
        for (unsigned c = 0; c < 8; ++c) {
          const Layer& of = c < 4 ? layer : above;
          const auto at = node(i + static_cast<int>(c & 1), j + static_cast<int>((c >> 1) & 1));
          inside |= static_cast<unsigned>(of.is_inside[at]) << c;
        }
        if (inside == 0 || inside == 255) continue;
        const CellCase& cell = cases()[inside];
        // Centres are numbered below -1 until the edges' vertices of all layers are counted.
        const int first_centre = static_cast<int>(layer.centres.size());
        for (const std::vector<int>& loop : cell.centred) {
          Vec3 centre = Vec3::Zero();
          for (const int e : loop) centre += coordinates(place_of(i, j, e));
          layer.centres.push_back(centre / static_cast<double>(loop.size()));
        }
        for (const std::array<int, 3>& triangle : cell.triangles) {
          std::array<int, 3> corners{};
          for (std::size_t c = 0; c < 3; ++c) {
            corners[c] = triangle[c] < 12 ? place_of(i, j, triangle[c])
                                          : -2 - (first_centre + triangle[c] - 12);
          }
          layer.triangles.push_back(corners);
        }
      }
    }
  });

  geometry::TriangleMesh mesh;
  std::vector<int> first_centre(layers.size());
  int count = first.back();
  std::size_t triangles = 0;
  for (std::size_t k = 0; k < layers.size(); ++k) {
    first_centre[k] = count;
    count += static_cast<int>(layers[k].centres.size());
    triangles += layers[k].triangles.size();
  }
  mesh.vertices.reserve(count);
  mesh.triangles.reserve(triangles);
  for (const Layer& layer : layers) {
    mesh.vertices.insert(mesh.vertices.end(), layer.places.begin(), layer.places.end());
  }
  for (const Layer& layer : layers) {
    mesh.vertices.insert(mesh.vertices.end(), layer.centres.begin(), layer.centres.end());
  }
  const bool is_mirrored = image.grid.axes.determinant() < 0.0;
  for (std::size_t k = 0; k < layers.size(); ++k) {
    for (std::array<int, 3> corners : layers[k].triangles) {
      for (int& c : corners) {
        if (c < -1) c = first_centre[k] + (-2 - c);
      }
      if (is_mirrored) std::swap(corners[1], corners[2]);
      mesh.triangles.push_back(corners);
    }
  }
  return mesh;
}

}  // namespace palmar::imaging
