// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/phantom/person/tube.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "palmar/hand/bones/bone_shape.h"

namespace palmar::phantom {
namespace {

constexpr int kAround = 10;
constexpr double kStep = 1.5;  // mm, between rings

std::vector<Vec3> curve_through(const std::vector<Vec3>& p) {
  std::vector<Vec3> curve;
  for (std::size_t k = 0; k + 1 < p.size(); ++k) {
    const Vec3 &b = p[k], &c = p[k + 1];
    const Vec3 a = k > 0 ? p[k - 1] : Vec3(2.0 * b - c);
    const Vec3 d = k + 2 < p.size() ? p[k + 2] : Vec3(2.0 * c - b);
    const int steps = std::max(1, static_cast<int>(std::ceil((c - b).norm() / kStep)));
    for (int s = 0; s < steps; ++s) {
      const double t = static_cast<double>(s) / steps;
      curve.push_back(0.5 * (2.0 * b + t * (c - a) + t * t * (2.0 * a - 5.0 * b + 4.0 * c - d) +
                             t * t * t * (3.0 * b - a - 3.0 * c + d)));
    }
  }
  curve.push_back(p.back());
  return curve;
}

}  // namespace

geometry::TriangleMesh tube_mesh(const std::vector<Vec3>& through, double radius) {
  const std::vector<Vec3> curve = curve_through(through);
  std::vector<Vec3> vertices{curve.front()};
  Vec3 side = (curve[1] - curve[0]).unitOrthogonal();
  for (std::size_t k = 1; k + 1 < curve.size(); ++k) {
    const Vec3 along = (curve[k + 1] - curve[k - 1]).normalized();
    side = (side - side.dot(along) * along).normalized();
    const Vec3 up = along.cross(side);
    const double from_end = kStep * static_cast<double>(std::min(k, curve.size() - 1 - k));
    const double r = radius * std::min(1.0, std::sqrt(from_end / (2.0 * radius)));
    for (int n = 0; n < kAround; ++n) {
      const double angle = 2.0 * std::numbers::pi * n / kAround;
      vertices.push_back(curve[k] + r * (std::cos(angle) * side + std::sin(angle) * up));
    }
  }
  vertices.push_back(curve.back());
  return hand::close_rings(std::move(vertices), kAround);
}

}  // namespace palmar::phantom
