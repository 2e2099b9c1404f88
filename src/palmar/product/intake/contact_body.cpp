// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/intake/contact_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/distance/ray_query.h"
#include "palmar/geometry/mesh/boundary_loops.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/rotation.h"

namespace palmar::product {
namespace {

constexpr int kSkyDirections = 48;
constexpr int kProbes = 2000;  // triangles looked at to determine whether there is a cavity at all

/// Directions over the hemisphere about z, dense as the cosine; Hammersley's points.
std::array<Vec3, kSkyDirections> hemisphere() {
  std::array<Vec3, kSkyDirections> directions;
  for (int i = 0; i < kSkyDirections; ++i) {
    double inverse = 0.0, digit = 0.5;
    for (int bits = i; bits > 0; bits /= 2, digit /= 2.0) inverse += digit * (bits % 2);
    const double radius = std::sqrt((i + 0.5) / kSkyDirections),
                 turn = 2.0 * std::numbers::pi * inverse;
    directions[i] =
        Vec3(radius * std::cos(turn), radius * std::sin(turn), std::sqrt(1.0 - radius * radius));
  }
  return directions;
}

/// Looks at a product from its own surface.
class Surroundings {
 public:
  Surroundings(const geometry::TriangleMesh& mesh, const ContactBodyOptions& options)
      : mesh_(mesh), options_(options), rays_(mesh), directions_(hemisphere()) {
    Box3 box;
    for (const Vec3& vertex : mesh.vertices) box.extend(vertex);
    off_ = 1e-5 * box.sizes().norm();
  }

  /// Share of the sky that is seen from the middle of a triangle; 1 for one without area.
  double sky(int triangle) const {
    const std::optional<Vec3> normal = normal_of(triangle);
    if (!normal) return 1.0;
    const Quat turned = geometry::shortest_rotation(Vec3::UnitZ(), *normal);
    const Vec3 from = middle(triangle) + off_ * *normal;
    int free = 0;
    for (const Vec3& direction : directions_) {
      if (!rays_.first_hit(from, turned * direction)) ++free;
    }
    return static_cast<double>(free) / kSkyDirections;
  }

  /// Thickness of the wall that parts a triangle from an outer face, mm; nothing if it is thick or
  /// has no outer face behind it.
  std::optional<double> wall(int triangle) const {
    const std::optional<Vec3> normal = normal_of(triangle);
    if (!normal) return std::nullopt;
    const auto hit =
        rays_.first_hit(middle(triangle) - off_ * *normal, -*normal, 0.0, options_.thin_wall);
    if (!hit || hit->triangle == triangle || sky(hit->triangle) < options_.outer_sky) {
      return std::nullopt;
    }
    return hit->distance + off_;
  }

  /// Free way straight out of a triangle, mm; nothing if there is no end to it.
  std::optional<double> way_across(int triangle) const {
    const std::optional<Vec3> normal = normal_of(triangle);
    if (!normal) return std::nullopt;
    const auto hit = rays_.first_hit(middle(triangle) + off_ * *normal, *normal);
    return hit ? std::optional(hit->distance + off_) : std::nullopt;
  }

 private:
  const Vec3& corner(int triangle, std::size_t k) const {
    return mesh_.vertices[mesh_.triangles[triangle][k]];
  }
  Vec3 middle(int triangle) const {
    return (corner(triangle, 0) + corner(triangle, 1) + corner(triangle, 2)) / 3.0;
  }
  std::optional<Vec3> normal_of(int triangle) const {
    const Vec3 normal = (corner(triangle, 1) - corner(triangle, 0))
                            .cross(corner(triangle, 2) - corner(triangle, 0));
    const double length = normal.norm();
    if (!(length > 0.0)) return std::nullopt;
    return normal / length;
  }

  const geometry::TriangleMesh& mesh_;
  const ContactBodyOptions& options_;
  geometry::RayQuery rays_;
  std::array<Vec3, kSkyDirections> directions_;
  double off_ = 0.0;
};

/// Triangles spread evenly over the area.
std::vector<int> probes_of(const geometry::TriangleMesh& mesh) {
  const double step = geometry::surface_area(mesh) / kProbes;
  std::vector<int> probes;
  double passed = 0.0, next = 0.5 * step;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const Triangle& corners = mesh.triangles[t];
    passed += geometry::triangle_area(mesh.vertices[corners[0]], mesh.vertices[corners[1]],
                                      mesh.vertices[corners[2]]);
    if (passed < next) continue;
    probes.push_back(t);
    while (next <= passed) next += step;
  }
  return probes;
}

bool has_cavity(const Surroundings& surroundings, const geometry::TriangleMesh& mesh,
                const ContactBodyOptions& options) {
  const std::vector<int> probes = probes_of(mesh);
  std::vector<char> is_in_one(probes.size(), 0);
  parallel_for(static_cast<int>(probes.size()), [&](int i) {
    const int t = probes[i];
    is_in_one[i] = surroundings.sky(t) < options.cavity_sky && surroundings.wall(t) ? 1 : 0;
  });
  return std::find(is_in_one.begin(), is_in_one.end(), 1) != is_in_one.end();
}

/// Grows `is_dropped` over neighbours that may belong to the cavity, too.
void spread(const geometry::MeshTopology& topology, const std::vector<char>& may_belong,
            std::vector<char>& is_dropped) {
  std::vector<int> waiting;
  for (std::size_t t = 0; t < is_dropped.size(); ++t) {
    if (is_dropped[t] != 0) waiting.push_back(static_cast<int>(t));
  }
  while (!waiting.empty()) {
    const int t = waiting.back();
    waiting.pop_back();
    for (int k = 0; k < 3; ++k) {
      const int twin = topology.twin[3 * t + k];
      if (twin < 0) continue;
      const auto other = static_cast<std::size_t>(twin / 3);
      if (is_dropped[other] != 0 || may_belong[other] == 0) continue;
      is_dropped[other] = 1;
      waiting.push_back(static_cast<int>(other));
    }
  }
}

/// Evens out the border of what is dropped: the share of sky is an estimate.
void even_out(const geometry::MeshTopology& topology, std::vector<char>& is_dropped) {
  constexpr int kRounds = 6;
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<char> before = is_dropped;
    for (std::size_t t = 0; t < is_dropped.size(); ++t) {
      int dropped = 0, neighbours = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const int twin = topology.twin[3 * t + k];
        if (twin < 0) continue;
        ++neighbours;
        dropped += before[twin / 3];
      }
      if (2 * dropped > neighbours) is_dropped[t] = 1;
      if (2 * dropped < neighbours) is_dropped[t] = 0;
    }
  }
}

/// Regions of a kind (dropped or not) that are smaller than a fingertip change sides: specks of a
/// rough scan are no cavity, and what stands alone in a cavity doesn't matter.
void absorb_specks(const geometry::TriangleMesh& mesh, const geometry::MeshTopology& topology,
                   char kind, std::vector<char>& is_dropped) {
  constexpr double kSmallest = 200.0;  // mm^2
  std::vector<char> was_seen(is_dropped.size(), 0);
  for (std::size_t first = 0; first < is_dropped.size(); ++first) {
    if (was_seen[first] != 0 || is_dropped[first] != kind) continue;
    std::vector<std::size_t> region = {first};
    was_seen[first] = 1;
    double area = 0.0;
    bool has_border = false;
    for (std::size_t next = 0; next < region.size(); ++next) {
      const std::size_t t = region[next];
      const Triangle& corners = mesh.triangles[t];
      area += geometry::triangle_area(mesh.vertices[corners[0]], mesh.vertices[corners[1]],
                                      mesh.vertices[corners[2]]);
      for (std::size_t k = 0; k < 3; ++k) {
        const int twin = topology.twin[3 * t + k];
        if (twin < 0) continue;
        const auto other = static_cast<std::size_t>(twin / 3);
        if (is_dropped[other] != kind) has_border = true;
        if (was_seen[other] != 0 || is_dropped[other] != kind) continue;
        was_seen[other] = 1;
        region.push_back(other);
      }
    }
    if (area >= kSmallest || (kind == 0 && !has_border)) continue;  // a small part of its own
    for (const std::size_t t : region) is_dropped[t] = kind == 0 ? 1 : 0;
  }
}

/// The triangles that stay, with the vertices that they use.
geometry::TriangleMesh without(const geometry::TriangleMesh& mesh,
                               const std::vector<char>& is_dropped) {
  geometry::TriangleMesh rest;
  std::vector<int> place(mesh.vertices.size(), -1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (is_dropped[t] != 0) continue;
    Triangle corners = mesh.triangles[t];
    for (int& v : corners) {
      int& at = place[v];
      if (at < 0) {
        at = rest.vertex_count();
        rest.vertices.push_back(mesh.vertices[v]);
      }
      v = at;
    }
    rest.triangles.push_back(corners);
  }
  return rest;
}

/// Closes each mouth by a fan. It lies deep in the cavity, so what it looks like doesn't matter;
/// that every edge has two sides does: the winding number is whole then.
void close_mouths(geometry::TriangleMesh& mesh) {
  for (const geometry::BoundaryLoop& loop :
       geometry::find_boundary_loops(mesh, geometry::build_topology(mesh)).loops) {
    const int middle = mesh.vertex_count();
    mesh.vertices.push_back(loop.centre);
    for (std::size_t k = 0; k < loop.corner.size(); ++k) {
      mesh.triangles.push_back({loop.corner[k], loop.corner[(k + 1) % loop.corner.size()], middle});
    }
  }
}

}  // namespace

void ContactBodyOptions::check() const {
  if (!(cavity_sky >= 0.0 && cavity_sky < 1.0)) {
    throw UsageError("cavity_sky is " + std::to_string(cavity_sky) + "; allowed is [0, 1)");
  }
  if (!(mouth_sky >= cavity_sky && mouth_sky <= 1.0)) {
    throw UsageError("mouth_sky is " + std::to_string(mouth_sky) +
                     "; allowed is from cavity_sky to 1");
  }
  if (!(outer_sky > 0.0 && outer_sky <= 1.0)) {
    throw UsageError("outer_sky is " + std::to_string(outer_sky) + "; allowed is (0, 1]");
  }
  if (!(thin_wall > 0.0 && std::isfinite(thin_wall))) {
    throw UsageError("thin_wall is " + std::to_string(thin_wall) + " mm; it must be above 0");
  }
}

ContactBody contact_body(const geometry::TriangleMesh& mesh, const ContactBodyOptions& options) {
  options.check();
  ContactBody body;
  const Surroundings surroundings(mesh, options);
  if (!has_cavity(surroundings, mesh, options)) {
    body.mesh = mesh;
    return body;
  }
  const auto count = mesh.triangles.size();
  std::vector<char> may_belong(count, 0), is_dropped(count, 0);
  std::vector<double> wall(count, std::numeric_limits<double>::infinity());
  parallel_for(static_cast<int>(count), [&](int t) {
    const double sky = surroundings.sky(t);
    if (sky >= options.mouth_sky) return;
    const auto thickness = surroundings.wall(t);
    if (thickness) wall[t] = *thickness;
    const bool sees_little = sky < options.cavity_sky;
    may_belong[t] = sees_little || thickness ? 1 : 0;
    is_dropped[t] = sees_little && thickness ? 1 : 0;
  });
  const geometry::MeshTopology topology = geometry::build_topology(mesh);
  spread(topology, may_belong, is_dropped);
  even_out(topology, is_dropped);
  absorb_specks(mesh, topology, 1, is_dropped);
  absorb_specks(mesh, topology, 0, is_dropped);
  body.dropped = static_cast<int>(std::count(is_dropped.begin(), is_dropped.end(), 1));
  if (body.dropped == 0) {
    body.mesh = mesh;
    return body;
  }
  body.thinnest_wall = std::numeric_limits<double>::infinity();
  std::vector<double> across;
  for (std::size_t t = 0; t < count; ++t) {
    if (is_dropped[t] == 0) continue;
    body.thinnest_wall = std::min(body.thinnest_wall, wall[t]);
    if (const auto way = surroundings.way_across(static_cast<int>(t))) across.push_back(*way);
  }
  const auto half = across.begin() + static_cast<std::ptrdiff_t>(across.size() / 2);
  std::nth_element(across.begin(), half, across.end());
  body.width = across.empty() ? std::numeric_limits<double>::infinity() : *half;
  body.mesh = without(mesh, is_dropped);
  close_mouths(body.mesh);
  return body;
}

}  // namespace palmar::product
