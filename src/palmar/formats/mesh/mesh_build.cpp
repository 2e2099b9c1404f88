// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/mesh/mesh_build.h"

#include <array>
#include <bit>
#include <cmath>

#include "palmar/core/error.h"
#include "palmar/formats/text_scan.h"

namespace palmar::formats {
namespace {

using Vec2 = Eigen::Vector2d;

double cross(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// The polygon in its own plane, counter-clockwise.
std::vector<Vec2> flatten(const std::vector<Vec3>& vertices, const std::vector<int>& corners) {
  const std::size_t n = corners.size();
  Vec3 normal = Vec3::Zero();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3& a = vertices[static_cast<std::size_t>(corners[i])];
    const Vec3& b = vertices[static_cast<std::size_t>(corners[(i + 1) % n])];
    normal += (a - vertices[static_cast<std::size_t>(corners[0])])
                  .cross(b - vertices[static_cast<std::size_t>(corners[0])]);
  }
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  // Dropping the largest axis keeps coordinates exact; the order keeps the sense of rotation.
  int u = (axis + 1) % 3;
  int v = (axis + 2) % 3;
  if (normal[axis] < 0.0) std::swap(u, v);
  std::vector<Vec2> flat(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3& p = vertices[static_cast<std::size_t>(corners[i])];
    flat[i] = {p[u], p[v]};
  }
  return flat;
}

bool is_convex(const std::vector<Vec2>& flat) {
  // No right turn, and only one turn around in all: a pentagram turns left everywhere too.
  const std::size_t n = flat.size();
  int x_reversals = 0;
  double last_dx = 0.0;
  double first_dx = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    if (cross(flat[i], flat[(i + 1) % n], flat[(i + 2) % n]) < 0.0) return false;
    const double dx = flat[(i + 1) % n].x() - flat[i].x();
    if (dx == 0.0) continue;
    if (last_dx * dx < 0.0) ++x_reversals;
    if (first_dx == 0.0) first_dx = dx;
    last_dx = dx;
  }
  if (first_dx * last_dx < 0.0) ++x_reversals;
  return x_reversals <= 2;
}

}  // namespace

void PolygonSplitter::split(const std::vector<Vec3>& vertices, const std::vector<int>& corners,
                            std::vector<Triangle>& triangles) {
  const std::size_t n = corners.size();
  if (n < 3) return;
  if (n > 3) {
    const std::size_t before = triangles.size();
    if (!is_convex(flatten(vertices, corners))) {
      if (clip_ears(vertices, corners, triangles)) return;
      triangles.resize(before);
      ++doubtful_;
    }
  }
  for (std::size_t i = 1; i + 1 < n; ++i) {
    triangles.push_back({corners[0], corners[i], corners[i + 1]});
  }
}

bool PolygonSplitter::clip_ears(const std::vector<Vec3>& vertices, const std::vector<int>& corners,
                                std::vector<Triangle>& triangles) {
  const std::vector<Vec2> flat = flatten(vertices, corners);
  std::vector<std::size_t> ring(corners.size());
  for (std::size_t i = 0; i < ring.size(); ++i) ring[i] = i;

  std::size_t at = 0;
  std::size_t misses = 0;
  while (ring.size() > 3) {
    if (misses == ring.size() || effort_left_ <= 0) return false;
    const std::size_t n = ring.size();
    const std::size_t before = ring[(at + n - 1) % n];
    const std::size_t tip = ring[at % n];
    const std::size_t after = ring[(at + 1) % n];
    const Vec2 &a = flat[before], &b = flat[tip], &c = flat[after];
    bool is_ear = cross(a, b, c) > 0.0;
    for (std::size_t k = 0; is_ear && k < n; ++k) {
      const std::size_t other = ring[k];
      if (other == before || other == tip || other == after) continue;
      const Vec2& p = flat[other];
      if (p == a || p == b || p == c) continue;  // bridges to holes name a place twice
      --effort_left_;
      is_ear = !(cross(a, b, p) >= 0.0 && cross(b, c, p) >= 0.0 && cross(c, a, p) >= 0.0);
    }
    --effort_left_;
    if (!is_ear) {
      // A corner on a straight line spans nothing; take it off once no proper ear is left.
      if (misses + 1 == n) {
        for (std::size_t k = 0; k < n; ++k) {
          const std::size_t p = ring[(k + n - 1) % n], q = ring[k], r = ring[(k + 1) % n];
          if (cross(flat[p], flat[q], flat[r]) == 0.0) {
            triangles.push_back({corners[p], corners[q], corners[r]});
            ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(k));
            misses = 0;
            at = 0;
            break;
          }
        }
        if (misses == 0) continue;
      }
      ++misses;
      at = (at + 1) % n;
      continue;
    }
    triangles.push_back({corners[before], corners[tip], corners[after]});
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(at % n));
    misses = 0;
    at %= ring.size();
  }
  triangles.push_back({corners[ring[0]], corners[ring[1]], corners[ring[2]]});
  return true;
}

std::size_t ExactWelder::Hash::operator()(const std::array<std::uint64_t, 3>& key) const {
  std::uint64_t h = 0;
  for (const std::uint64_t part : key) {
    h ^= part + 0x9e3779b97f4a7c15ull + (h << 6) + (h >> 2);
    h *= 0xff51afd7ed558ccdull;
    h ^= h >> 32;
  }
  return static_cast<std::size_t>(h);
}

int ExactWelder::add(const Vec3& position, std::vector<Vec3>& vertices) {
  std::array<std::uint64_t, 3> key{};
  for (int c = 0; c < 3; ++c) {
    key[static_cast<std::size_t>(c)] = std::bit_cast<std::uint64_t>(position[c] + 0.0);
  }
  const auto [place, is_new] = index_.try_emplace(key, static_cast<int>(vertices.size()));
  if (is_new) vertices.push_back(position);
  return place->second;
}

void check_position(const Vec3& position, const std::string& where) {
  constexpr double kLargest = 1e12;  // file units; far beyond any product, far below overflow
  for (int c = 0; c < 3; ++c) {
    const double value = position[c];
    if (std::abs(value) <= kLargest) continue;
    throw InputError(where + ": " + "xyz"[c] + " is " + shortest(value) +
                     (std::isfinite(value) ? "; a size up to 1e12 is allowed"
                                           : "; a finite number is required"));
  }
}

void check_triangle_count(const std::string& name, std::uint64_t count) {
  if (count > static_cast<std::uint64_t>(kMaxTriangles)) {
    throw InputError(name + ": holds " + std::to_string(count) + " triangles; up to " +
                     std::to_string(kMaxTriangles) + " are read");
  }
}

void finish_mesh(MeshFile& file, const std::string& name, geometry::SurfaceColours* colours) {
  geometry::TriangleMesh& mesh = file.mesh;
  if (mesh.triangles.empty()) {
    throw InputError(name + ": holds " +
                     (mesh.vertices.empty()
                          ? std::string("no triangles")
                          : std::to_string(mesh.vertices.size()) + " vertices but no faces") +
                     "; a surface mesh is required");
  }
  check_triangle_count(name, mesh.triangles.size());

  const std::size_t before = mesh.triangles.size();
  const auto is_collapsed = [](const Triangle& t) {
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
  };
  if (colours != nullptr && !colours->texture.empty()) {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < before; ++t) {
      if (is_collapsed(mesh.triangles[t])) continue;
      colours->texture[kept] = colours->texture[t];
      colours->place[kept++] = colours->place[t];
    }
    colours->texture.resize(kept);
    colours->place.resize(kept);
  }
  std::erase_if(mesh.triangles, is_collapsed);
  const std::size_t dropped = before - mesh.triangles.size();
  if (mesh.triangles.empty()) {
    throw InputError(name + ": all " + std::to_string(dropped) +
                     " triangles have two equal corners; a surface mesh is required");
  }
  if (dropped > 0) {
    file.notes.push_back(std::to_string(dropped) + " triangles with two equal corners dropped");
  }

  std::vector<int> renumbered(mesh.vertices.size(), -1);
  for (const Triangle& t : mesh.triangles) {
    for (const int v : t) renumbered[static_cast<std::size_t>(v)] = 0;
  }
  std::size_t used = 0;
  for (std::size_t v = 0; v < renumbered.size(); ++v) {
    if (renumbered[v] < 0) continue;
    renumbered[v] = static_cast<int>(used);
    if (colours != nullptr) colours->copy_vertex(v, used);
    mesh.vertices[used++] = mesh.vertices[v];
  }
  if (used == mesh.vertices.size()) return;
  file.notes.push_back(std::to_string(mesh.vertices.size() - used) +
                       " vertices that belong to no triangle dropped");
  mesh.vertices.resize(used);
  if (colours != nullptr) colours->keep_vertices(used);
  for (Triangle& t : mesh.triangles) {
    for (int& v : t) v = renumbered[static_cast<std::size_t>(v)];
  }
}

}  // namespace palmar::formats
