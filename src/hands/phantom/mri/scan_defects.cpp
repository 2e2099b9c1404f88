// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/phantom/mri/scan_defects.h"
#include "hands/phantom/person/person_random.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "hands/phantom/person/smooth_noise.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/core/random.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/distance/ray_query.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/repair/weld.h"

namespace palmar::phantom {
namespace {

enum DefectStream : std::uint64_t { kRough = 70, kColour, kPlace, kRipples };

/// Directions spread evenly over the sphere (Fibonacci lattice).
std::vector<Vec3> directions(int count) {
  std::vector<Vec3> all;
  for (int k = 0; k < count; ++k) {
    const double z = 1.0 - (2.0 * k + 1.0) / count,
                 turn = k * std::numbers::pi * (3.0 - std::sqrt(5.0));
    const double r = std::sqrt(1.0 - z * z);
    all.emplace_back(r * std::cos(turn), r * std::sin(turn), z);
  }
  return all;
}

/// Share of all directions in which each triangle sees the open.
std::vector<double> openness(const geometry::TriangleMesh& mesh) {
  const geometry::RayQuery rays(mesh);
  const std::vector<Vec3> ways = directions(64);
  std::vector<double> share(mesh.triangles.size());
  parallel_for(mesh.triangle_count(), [&](int t) {
    const Triangle& c = mesh.triangles[t];
    const Vec3 &a = mesh.vertices[c[0]], &b = mesh.vertices[c[1]], &d = mesh.vertices[c[2]];
    const Vec3 normal = (b - a).cross(d - a).normalized();
    const Vec3 from = (a + b + d) / 3.0 + 0.02 * normal;
    int open = 0;
    for (const Vec3& way : ways) {
      if (way.dot(normal) > 0.05 && !rays.first_hit(from, way)) ++open;
    }
    share[t] = static_cast<double>(open) / static_cast<double>(ways.size());
  });
  return share;
}

geometry::ColouredMesh kept(const geometry::ColouredMesh& surface, const std::vector<char>& keep) {
  geometry::TriangleMesh mesh{surface.mesh.vertices, {}};
  for (std::size_t t = 0; t < keep.size(); ++t) {
    if (keep[t]) mesh.triangles.push_back(surface.mesh.triangles[t]);
  }
  geometry::WeldOptions options;
  options.tolerance = 0.0;
  options.drops_duplicates = false;
  const geometry::WeldResult welded = geometry::weld(mesh, options);
  geometry::ColouredMesh result{welded.mesh, {}};
  for (const int old : welded.old_of_new) result.colour.push_back(surface.colour[old]);
  return result;
}

}  // namespace

void ScanDefects::check() const {
  const auto hold = [](const char* field, double value, double least, double most) {
    if (!(value >= least && value <= most)) {
      throw UsageError(fmt::format("{} is {}; {} to {} is allowed", field, value, least, most));
    }
  };
  hold("noise", noise, 0.0, 3.0);
  hold("roughness", roughness, 0.0, 2.0);
  hold("hidden", hidden, 0.0, 0.5);
  hold("forearm", forearm, 0.0, 80.0);
  hold("colour_noise", colour_noise, 0.0, 0.5);
}

ScannedSurface scanned_surface(const geometry::ColouredMesh& hand, double wrist_y,
                               const ScanDefects& defects) {
  defects.check();
  const std::vector<double> open = openness(hand.mesh);
  std::vector<char> keep(hand.mesh.triangles.size());
  for (std::size_t t = 0; t < keep.size(); ++t) {
    double lowest = 1e9;
    for (const int v : hand.mesh.triangles[t]) {
      lowest = std::min(lowest, hand.mesh.vertices[v].y());
    }
    keep[t] = lowest > wrist_y - defects.forearm && open[t] >= defects.hidden ? 1 : 0;
  }
  ScannedSurface scan;
  scan.surface = kept(hand, keep);
  geometry::TriangleMesh& mesh = scan.surface.mesh;
  RandomStream rough(defects.seed, kRough), colour(defects.seed, kColour);
  const SmoothNoise longer(defects.seed, kRipples, 8.0), shorter(defects.seed + 1, kRipples, 3.0);
  const std::vector<Vec3> normal = geometry::vertex_normals(mesh);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3 p = mesh.vertices[v];
    const double out = defects.noise * std::sqrt(0.5) * (longer.at(p) + shorter.at(p)) +
                       defects.roughness * rough.normal();
    mesh.vertices[v] += out * normal[v];
    for (int k = 0; k < 3; ++k) {
      float& c = scan.surface.colour[v][k];
      c = std::clamp(c + static_cast<float>(defects.colour_noise * colour.normal()), 0.0F, 1.0F);
    }
  }
  // Anywhere: any turn, half a metre away.
  RandomStream place(defects.seed, kPlace);
  Eigen::Vector4d q;
  for (int k = 3; k >= 0; --k) q[k] = place.normal();
  q.normalize();
  scan.scan_from_hand = {Quat(q[0], q[1], q[2], q[3]), normal_vector(place) * 300.0};
  for (Vec3& v : mesh.vertices) v = scan.scan_from_hand * v;
  return scan;
}

TexturedSurface textured_surface(const geometry::TriangleMesh& coarse,
                                 const geometry::ColouredMesh& fine, int side) {
  if (side < 64) throw UsageError(fmt::format("side is {}; 64 pixels at least are required", side));
  const int squares = (coarse.triangle_count() + 1) / 2;
  const int per_row = static_cast<int>(std::ceil(std::sqrt(squares)));
  const int cell = side / per_row;
  if (cell < 5) {
    throw UsageError(fmt::format("{} triangles don't fit into {} x {} pixels",
                                 coarse.triangle_count(), side, side));
  }
  TexturedSurface result{coarse, {}};
  geometry::RgbImage image{
      side, side,
      std::vector<std::uint8_t>(std::size_t{3} * static_cast<std::size_t>(side) * side)};
  // The lower left half of a square shows one triangle, the upper right half the other, each with a
  // border of a pixel that goes on beyond it.
  const auto corner_of = [&](int t) {
    const int square = t / 2;
    const bool is_second = t % 2 == 1;
    const double x = (square % per_row) * cell, y = (square / per_row) * cell;
    const double near = 1.0, far = cell - 2.5;
    using V = Eigen::Vector2d;
    if (!is_second)
      return std::array<V, 3>{V(x + near, y + near + 1.5), V(x + near, y + far + 1.5),
                              V(x + far, y + far + 1.5)};
    return std::array<V, 3>{V(x + far + 1.5, y + far), V(x + far + 1.5, y + near),
                            V(x + near + 1.5, y + near)};
  };
  const geometry::ClosestPointQuery query(fine.mesh);
  parallel_for(coarse.triangle_count(), [&](int t) {
    const auto p = corner_of(t);
    const Triangle& c = coarse.triangles[t];
    Eigen::Matrix2d base;
    base << p[1] - p[0], p[2] - p[0];
    const Eigen::Matrix2d inverse = base.inverse();
    const int square = t / 2;
    const int x0 = (square % per_row) * cell, y0 = (square / per_row) * cell;
    std::optional<int> hint;
    for (int y = y0; y < y0 + cell; ++y) {
      for (int x = x0; x < x0 + cell; ++x) {
        const bool is_upper = x - x0 > y - y0;
        if (is_upper != (t % 2 == 1)) continue;
        const Eigen::Vector2d w = inverse * (Eigen::Vector2d(x + 0.5, y + 0.5) - p[0]);
        const Vec3 q = (1.0 - w[0] - w[1]) * coarse.vertices[c[0]] + w[0] * coarse.vertices[c[1]] +
                       w[1] * coarse.vertices[c[2]];
        const auto near = query.closest(q, std::numeric_limits<double>::infinity(), hint);
        hint = near->triangle;
        geometry::Srgb colour = geometry::Srgb::Zero();
        for (std::size_t k = 0; k < 3; ++k) {
          colour += static_cast<float>(near->weights[k]) *
                    fine.colour[fine.mesh.triangles[near->triangle][k]];
        }
        const std::size_t pixel = 3 * (static_cast<std::size_t>(y) * side + x);
        for (int k = 0; k < 3; ++k) {
          image.rgb[pixel + static_cast<std::size_t>(k)] =
              static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(colour[k], 0.0F, 1.0F)));
        }
      }
    }
  });
  for (int t = 0; t < coarse.triangle_count(); ++t) {
    const auto p = corner_of(t);
    std::array<Eigen::Vector2f, 3> place;
    for (std::size_t k = 0; k < 3; ++k) place[k] = (p[k] / side).cast<float>();
    result.colours.place.push_back(place);
    result.colours.texture.push_back(0);
  }
  result.colours.textures.push_back(std::move(image));
  return result;
}

}  // namespace palmar::phantom
