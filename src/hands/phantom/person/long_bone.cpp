// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/phantom/person/long_bone.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/remesh/smooth.h"
#include "palmar/hand/bones/bone_shape.h"

namespace palmar::phantom {
namespace {

constexpr int kAround = 36;
constexpr double kEdge = 0.9;  // mm, between rings

// Cross-section of a bone, a little squarer than an ellipse.
double outline(double half_width, double half_depth, double angle) {
  const double c = std::abs(std::cos(angle)) / half_width,
               s = std::abs(std::sin(angle)) / half_depth;
  constexpr double kPower = 2.4;
  return std::pow(std::pow(c, kPower) + std::pow(s, kPower), -1.0 / kPower);
}

double fade(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return (1.0 - t) * (1.0 - t) * (1.0 + 2.0 * t);
}

// Distance from the head's centre to its surface towards (along, lateral, palmar).
double reach(const JointSurface& surface, const Vec3& direction) {
  double inside = 0.0, outside = 1.6 * std::max(surface.radius, surface.half_width);
  for (int k = 0; k < 30; ++k) {
    const Vec3 p = 0.5 * (inside + outside) * direction;
    (std::hypot(p.x(), p.z()) < surface.at(p.y()) ? inside : outside) = 0.5 * (inside + outside);
  }
  return inside;
}

// Half of a bone's longitudinal section at one angle: x along the bone from the base joint, rho
// from its axis.
std::vector<Eigen::Vector2d> section(const LongBoneShape& shape, double length, double angle,
                                     int shaft_rings) {
  std::vector<Eigen::Vector2d> curve;
  const double c = std::cos(angle), s = std::sin(angle);
  // Base, from its middle to the rim.
  const double rim = outline(shape.base_half_width, shape.base_half_depth, angle);
  double x = shape.gap;
  constexpr int kBaseRings = 7;
  for (int k = 1; k <= kBaseRings; ++k) {
    const double rho = 0.92 * rim * k / kBaseRings;
    if (shape.socket) {
      const double w = rho * c, p = rho * s;
      const double r = shape.socket->at(std::clamp(w, -0.85 * shape.socket->half_width,
                                                   0.85 * shape.socket->half_width)) +
                       shape.gap;
      x = std::sqrt(r * r - std::min(p * p, 0.75 * r * r));
    } else {
      x = shape.gap + 0.5 * (1.0 - std::cos(3.0 * rho / rim)) * 0.3;
    }
    curve.emplace_back(x, rho);
  }
  const double rim_x = x + 1.1;
  // Head, from its side to its tip.
  const double side_angle = (s > 0.0 ? 2.0 : 1.8) - 0.15 * std::abs(c);
  const auto head_point = [&](double polar) -> Eigen::Vector2d {
    const double t =
        reach(shape.condyles, {std::cos(polar), std::sin(polar) * c, std::sin(polar) * s});
    return {length + t * std::cos(polar), t * std::sin(polar)};
  };
  const Eigen::Vector2d side = head_point(side_angle);
  // Shaft between them.
  const double first = rim_x, last = side.x();
  const double waist = outline(shape.waist_half_width, shape.waist_half_depth, angle) *
                       (s > 0.0 ? 1.0 - 0.12 * s * s : 1.0) *
                       (1.0 + shape.ripple * std::cos(3.0 * (angle - shape.twist)));
  for (int k = 0; k <= shaft_rings; ++k) {
    const double t = double(k) / (shaft_rings + 1);
    const double rho =
        waist + (rim - waist) * fade(t / 0.5) + (side.y() - waist) * fade((1.0 - t) / 0.42);
    curve.emplace_back(first + t * (last - first), rho);
  }
  constexpr int kHeadRings = 13;
  for (int k = 0; k < kHeadRings; ++k) {
    curve.push_back(head_point(side_angle * (1.0 - double(k) / kHeadRings)));
  }
  return curve;
}

}  // namespace

double JointSurface::at(double w) const {
  const double share = std::min(std::abs(w) / half_width, 1.0);
  const double valley = w / (0.3 * half_width);
  return (radius - groove * std::exp(-valley * valley)) * std::cbrt(1.0 - std::pow(share, 5.0));
}

geometry::TriangleMesh long_bone_mesh(const LongBoneShape& shape) {
  const double length = (shape.head - shape.base).norm();
  const Vec3 along = (shape.head - shape.base) / length;
  const Vec3 lateral = (shape.lateral - shape.lateral.dot(along) * along).normalized();
  const Vec3 palmar = lateral.cross(along);
  const int shaft_rings = std::max(6, static_cast<int>(0.75 * length / kEdge));
  std::vector<std::vector<Eigen::Vector2d>> sections;
  for (int k = 0; k < kAround; ++k) {
    sections.push_back(section(shape, length, 2.0 * std::numbers::pi * k / kAround, shaft_rings));
  }
  const double begin = shape.socket ? shape.socket->at(0.0) + shape.gap : shape.gap;
  const double end = length + shape.condyles.at(0.0);
  const auto place = [&](double x, double rho, double angle) -> Vec3 {
    const double t = std::clamp((x - begin) / (end - begin), 0.0, 1.0);
    const double dorsal = shape.bow * std::pow(std::sin(std::numbers::pi * t), 2.0);
    return shape.base + x * along + rho * std::cos(angle) * lateral +
           (rho * std::sin(angle) - dorsal) * palmar;
  };
  std::vector<Vec3> vertices{place(begin, 0.0, 0.0)};
  for (std::size_t ring = 0; ring < sections.front().size(); ++ring) {
    for (int k = 0; k < kAround; ++k) {
      const Eigen::Vector2d& p = sections[k][ring];
      vertices.push_back(place(p.x(), p.y(), 2.0 * std::numbers::pi * k / kAround));
    }
  }
  vertices.push_back(place(end, 0.0, 0.0));
  // Takes the corners off where base, shaft and head meet.
  return geometry::smooth_taubin(hand::close_rings(std::move(vertices), kAround), {.rounds = 6});
}

}  // namespace palmar::phantom
