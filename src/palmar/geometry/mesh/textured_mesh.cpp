// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/mesh/textured_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <unordered_map>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_measures.h"

namespace palmar::geometry {
namespace {

Srgb pixel(const RgbImage& image, int column, int row) {
  const auto round = [](int i, int n) { return (i % n + n) % n; };
  const std::size_t p = 3 * (static_cast<std::size_t>(round(row, image.height)) * image.width +
                             static_cast<std::size_t>(round(column, image.width)));
  return Srgb(image.rgb[p], image.rgb[p + 1], image.rgb[p + 2]) / 255.0F;
}

/// Splits edges at their middles until none is too long.
class Refiner {
 public:
  Refiner(const TriangleMesh& mesh, const SurfaceColours& colours, double edge_length)
      : mesh_(mesh), colours_(colours), squared_(edge_length * edge_length) {}

  void refine() {
    // No triangle with such edges is larger than the equilateral one.
    const double least = surface_area(mesh_) / (0.25 * std::sqrt(3.0) * squared_);
    if (!(least <= kMaxColouredTriangles)) refuse();
    while (split_once()) {
      if (mesh_.triangle_count() > kMaxColouredTriangles) refuse();
    }
  }

  ColouredMesh result() {
    ColouredMesh out;
    out.colour.assign(mesh_.vertices.size(), Srgb::Zero());
    std::vector<float> count(mesh_.vertices.size(), 0.0F);
    for (std::size_t t = 0; t < colours_.texture.size(); ++t) {
      const int image = colours_.texture[t];
      if (image < 0 || colours_.textures[image].rgb.empty()) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const int v = mesh_.triangles[t][k];
        out.colour[v] += colour_at(colours_.textures[image], colours_.place[t][k]);
        count[v] += 1.0F;
      }
    }
    for (std::size_t v = 0; v < count.size(); ++v) {
      if (count[v] > 0.0F) {
        out.colour[v] /= count[v];
      } else if (!colours_.vertex.empty()) {
        out.colour[v] = colours_.vertex[v];
      }
    }
    out.mesh = std::move(mesh_);
    return out;
  }

 private:
  [[noreturn]] void refuse() const {
    throw InputError("edges of " + std::to_string(std::sqrt(squared_)) + " would need more than " +
                     std::to_string(kMaxColouredTriangles) +
                     " triangles; the mesh is too large for its unit");
  }

  bool is_long(int a, int b) const {
    return (mesh_.vertices[a] - mesh_.vertices[b]).squaredNorm() > squared_;
  }

  int middle(int a, int b) {
    const std::uint64_t key = static_cast<std::uint64_t>(std::min(a, b)) << 32 |
                              static_cast<std::uint32_t>(std::max(a, b));
    const auto [place, is_new] = middle_.try_emplace(key, mesh_.vertex_count());
    if (is_new) {
      mesh_.vertices.push_back(0.5 * (mesh_.vertices[a] + mesh_.vertices[b]));
      if (!colours_.vertex.empty()) {
        colours_.vertex.push_back(0.5F * (colours_.vertex[a] + colours_.vertex[b]));
      }
    }
    return place->second;
  }

  /// One round: whether an edge is split depends on the edge alone, so neighbours agree.
  bool split_once() {
    middle_.clear();
    const bool has_places = !colours_.place.empty();
    std::vector<Triangle> triangles;
    std::vector<std::array<Eigen::Vector2f, 3>> place;
    std::vector<int> texture;
    bool is_split = false;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const Triangle corner = mesh_.triangles[t];
      // Corners 0 to 2, then the middles of the edges from them.
      std::array<int, 6> node{corner[0], corner[1], corner[2], -1, -1, -1};
      std::array<Eigen::Vector2f, 6> spot;
      spot.fill(Eigen::Vector2f::Zero());
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = (k + 1) % 3;
        if (has_places) {
          spot[k] = colours_.place[t][k];
          spot[k + 3] = 0.5F * (colours_.place[t][k] + colours_.place[t][next]);
        }
        if (is_long(corner[k], corner[next])) node[k + 3] = middle(corner[k], corner[next]);
      }
      const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
        triangles.push_back({node[a], node[b], node[c]});
        if (has_places) place.push_back({spot[a], spot[b], spot[c]});
        if (!colours_.texture.empty()) texture.push_back(colours_.texture[t]);
      };
      is_split = split_triangle(node, add) || is_split;
    }
    mesh_.triangles = std::move(triangles);
    colours_.place = std::move(place);
    colours_.texture = std::move(texture);
    return is_split;
  }

  template <typename Add>
  bool split_triangle(const std::array<int, 6>& node, const Add& add) const {
    const int splits = (node[3] >= 0) + (node[4] >= 0) + (node[5] >= 0);
    if (splits == 0) {
      add(0, 1, 2);
    } else if (splits == 3) {
      add(0, 3, 5);
      add(3, 1, 4);
      add(5, 4, 2);
      add(3, 4, 5);
    } else if (splits == 1) {
      const std::size_t k = node[3] >= 0 ? 0 : node[4] >= 0 ? 1 : 2;  // the edge from corner k
      const std::size_t next = (k + 1) % 3, last = (k + 2) % 3;
      add(k, k + 3, last);
      add(k + 3, next, last);
    } else {
      const std::size_t k = node[3] < 0 ? 0 : node[4] < 0 ? 1 : 2;  // the edge that stays whole
      const std::size_t next = (k + 1) % 3, last = (k + 2) % 3;
      add(next + 3, last, last + 3);
      // The rest is a quadrangle: its shorter diagonal.
      const auto squared = [&](std::size_t a, std::size_t b) {
        return (mesh_.vertices[node[a]] - mesh_.vertices[node[b]]).squaredNorm();
      };
      if (squared(k, next + 3) <= squared(next, last + 3)) {
        add(k, next, next + 3);
        add(k, next + 3, last + 3);
      } else {
        add(k, next, last + 3);
        add(next, next + 3, last + 3);
      }
    }
    return splits > 0;
  }

  TriangleMesh mesh_;
  SurfaceColours colours_;
  double squared_;
  std::unordered_map<std::uint64_t, int> middle_;
};

}  // namespace

void SurfaceColours::copy_vertex(std::size_t from, std::size_t to) {
  if (!vertex.empty()) vertex[to] = vertex[from];
  if (!is_guess.empty()) is_guess[to] = is_guess[from];
}

void SurfaceColours::keep_vertices(std::size_t count) {
  if (!vertex.empty()) vertex.resize(count);
  if (!is_guess.empty()) is_guess.resize(count);
}

Srgb colour_at(const RgbImage& image, const Eigen::Vector2f& place) {
  if (image.rgb.empty() || !place.allFinite()) return Srgb::Zero();
  const auto within = [](float x) { return x - std::floor(x); };
  // 1 stands for the far border, not for the near one.
  const auto turned = [&](float x) { return x == 1.0F ? 1.0F : within(x); };
  const float x = turned(place.x()) * static_cast<float>(image.width) - 0.5F;
  const float y = turned(place.y()) * static_cast<float>(image.height) - 0.5F;
  const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
  const float u = x - static_cast<float>(column), v = y - static_cast<float>(row);
  return (1.0F - v) * ((1.0F - u) * pixel(image, column, row) + u * pixel(image, column + 1, row)) +
         v * ((1.0F - u) * pixel(image, column, row + 1) + u * pixel(image, column + 1, row + 1));
}

ColouredMesh coloured_mesh(const TriangleMesh& mesh, const SurfaceColours& colours,
                           double edge_length) {
  if (colours.empty()) throw UsageError("the mesh has no colours");
  if (!(edge_length > 0.0)) {
    throw UsageError("edge_length is " + std::to_string(edge_length) + "; more than 0 is required");
  }
  Refiner refiner(mesh, colours, edge_length);
  refiner.refine();
  return refiner.result();
}

}  // namespace palmar::geometry
