// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/bones/bone_shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "palmar/geometry/mesh/mesh_measures.h"

namespace palmar::hand {
namespace {

double smooth(double t) { return t * t * (3.0 - 2.0 * t); }

BoneStation station_at(const std::vector<BoneStation>& stations, double share) {
  if (share <= stations.front().share) return stations.front();
  if (share >= stations.back().share) return stations.back();
  const auto next = std::find_if(stations.begin(), stations.end(),
                                 [&](const BoneStation& s) { return s.share > share; });
  const auto previous = next - 1;
  const double t = smooth((share - previous->share) / (next->share - previous->share));
  return {.share = share,
          .half_width = (1.0 - t) * previous->half_width + t * next->half_width,
          .half_depth = (1.0 - t) * previous->half_depth + t * next->half_depth};
}

}  // namespace

geometry::TriangleMesh close_rings(std::vector<Vec3> vertices, int around) {
  geometry::TriangleMesh mesh;
  mesh.vertices = std::move(vertices);
  const auto corner = [&](int ring, int k) { return 1 + ring * around + k % around; };
  const int last = mesh.vertex_count() - 1, rings = (last - 1) / around;
  for (int k = 0; k < around; ++k) {
    mesh.triangles.push_back({0, corner(0, k + 1), corner(0, k)});
    for (int ring = 0; ring + 1 < rings; ++ring) {
      mesh.triangles.push_back({corner(ring, k), corner(ring, k + 1), corner(ring + 1, k)});
      mesh.triangles.push_back({corner(ring, k + 1), corner(ring + 1, k + 1), corner(ring + 1, k)});
    }
    mesh.triangles.push_back({last, corner(rings - 1, k), corner(rings - 1, k + 1)});
  }
  if (geometry::signed_volume(mesh) < 0.0) {
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  }
  return mesh;
}

geometry::TriangleMesh bone_mesh(const BoneShape& shape) {
  const double length = (shape.to - shape.from).norm();
  const Vec3 along = (shape.to - shape.from) / length;
  const Vec3 lateral = along.cross(shape.palmar).normalized();
  const Vec3 palmar = lateral.cross(along);
  std::vector<Vec3> vertices{shape.from};
  for (int ring = 0; ring < shape.rings; ++ring) {
    // Rings crowd towards the ends, where the caps turn; the outermost stand just off the poles.
    const double even = (ring + 0.6) / (shape.rings + 0.2);
    const double share = 0.5 - 0.5 * std::cos(std::numbers::pi * even);
    const double x = share * length;
    double round = 1.0;
    if (x < shape.base_cap) {
      // A flat, shallow base: the fourth power keeps its rim wide.
      const double t = 1.0 - x / shape.base_cap;
      round = std::pow(1.0 - t * t * t * t, 0.25);
    }
    if (length - x < shape.head_cap) {
      const double t = 1.0 - (length - x) / shape.head_cap;
      round = std::min(round, std::sqrt(1.0 - t * t));
    }
    const BoneStation s = station_at(shape.station, share);
    // The condyles belong to the last quarter.
    const double head = smooth(std::clamp((share - 0.7) / 0.2, 0.0, 1.0));
    for (int k = 0; k < shape.around; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / shape.around;
      const double across = std::cos(angle), up = std::sin(angle);
      // Shafts are flat on the palmar side; heads are grooved there and at their end.
      const double flat = up > 0.0 ? 1.0 - 0.15 * (1.0 - head) * up : 1.0;
      const double middle = std::pow(1.0 - across * across, 2.0);
      const double grooved = up > 0.0 ? head * shape.groove * middle : 0.0;
      const double deep = std::max(0.5 * s.half_depth, flat * s.half_depth - grooved);
      const double back = head * shape.groove * (1.0 - across * across * round * round);
      vertices.push_back(shape.from + (x - back * head) * along +
                         round * (across * s.half_width * lateral + up * deep * palmar));
    }
  }
  vertices.push_back(shape.to - shape.groove * along);
  return close_rings(std::move(vertices), shape.around);
}

geometry::TriangleMesh ellipsoid_mesh(const Vec3& centre, const Eigen::Matrix3d& axes,
                                      const Vec3& half_axes, int rings, int around) {
  const auto place = [&](double x, double y, double z) -> Vec3 {
    return centre + axes * Vec3(x * half_axes.x(), y * half_axes.y(), z * half_axes.z());
  };
  std::vector<Vec3> vertices{place(0.0, -1.0, 0.0)};
  for (int ring = 0; ring < rings; ++ring) {
    const double polar = std::numbers::pi * (ring + 1) / (rings + 1);
    for (int k = 0; k < around; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / around;
      vertices.push_back(place(std::sin(polar) * std::cos(angle), -std::cos(polar),
                               std::sin(polar) * std::sin(angle)));
    }
  }
  vertices.push_back(place(0.0, 1.0, 0.0));
  return close_rings(std::move(vertices), around);
}

}  // namespace palmar::hand
