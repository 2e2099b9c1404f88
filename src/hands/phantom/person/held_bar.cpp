// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/phantom/person/held_bar.h"

#include <cmath>

#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/geometry/rotation.h"

namespace palmar::phantom {
namespace {

constexpr double kHalfLength = 70.0;  // mm
}  // namespace

double HeldBar::distance(const Vec3& p) const {
  const Vec3 arm = p - point;
  return (arm - arm.dot(axis) * axis).norm();
}

void flatten_on(const HeldBar& bar, std::vector<Vec3>& skin) {
  for (Vec3& v : skin) {
    const Vec3 arm = v - bar.point;
    const double along = arm.dot(bar.axis);
    const Vec3 out = arm - along * bar.axis;
    const double r = out.norm();
    if (std::abs(along) > kHalfLength || r >= bar.radius || r < 0.5 * bar.radius) continue;
    v += (bar.radius - r) / r * out;
  }
}

geometry::TriangleMesh bar_mesh(const HeldBar& bar) {
  geometry::TriangleMesh mesh = geometry::make_cylinder(
      {.radius = bar.radius, .length = 2.0 * kHalfLength, .segments = 72, .rings = 48});
  const Quat turn = geometry::shortest_rotation(Vec3::UnitZ(), bar.axis);
  for (Vec3& v : mesh.vertices) v = bar.point + turn * v;
  return mesh;
}

}  // namespace palmar::phantom
