// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/photo/photo_camera.h"

#include <fmt/format.h>

#include <cmath>

#include "palmar/core/error.h"

namespace palmar::capture {

void PhotoLens::check(const std::string& name) const {
  constexpr int kLeast = 64, kMost = 16384;
  const auto fail = [&](const char* field, double value, const char* allowed) {
    throw InputError(fmt::format("{}: {} is {:g}; {} is allowed", name, field, value, allowed));
  };
  for (const int side : {width, height}) {
    if (side < kLeast || side > kMost) fail("a side of the picture", side, "64 to 16384 pixels");
  }
  const double size = std::max(width, height);
  for (const double focal : {focal_x, focal_y}) {
    if (!(focal >= 0.2 * size && focal <= 50.0 * size)) {
      fail("focal length", focal, "0.2 to 50 times the longer side, in pixels,");
    }
  }
  if (!(centre_x > -size && centre_x < 2 * size)) fail("centre_x", centre_x, "a pixel near it");
  if (!(centre_y > -size && centre_y < 2 * size)) fail("centre_y", centre_y, "a pixel near it");
  if (!(std::abs(k1) < 2.0)) fail("k1", k1, "-2 to 2");
  if (!(std::abs(k2) < 10.0)) fail("k2", k2, "-10 to 10");
}

Eigen::Vector2d PhotoLens::pixel_of(const Eigen::Vector2d& direction) const {
  const double r2 = direction.squaredNorm();
  const double d = 1.0 + r2 * (k1 + r2 * k2);
  return {focal_x * d * direction.x() + centre_x, focal_y * d * direction.y() + centre_y};
}

Eigen::Vector2d PhotoLens::direction_of(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d distorted((pixel.x() - centre_x) / focal_x,
                                  (pixel.y() - centre_y) / focal_y);
  const double rd = distorted.norm();
  if (rd == 0.0) return distorted;
  double r = rd;
  constexpr int kRounds = 10;
  for (int i = 0; i < kRounds; ++i) {
    const double r2 = r * r;
    const double slope = 1.0 + r2 * (3.0 * k1 + 5.0 * r2 * k2);
    const double step = (r * (1.0 + r2 * (k1 + r2 * k2)) - rd) / std::max(slope, 0.1);
    r -= step;
    if (std::abs(step) < 1e-14) break;
  }
  return distorted * (r / rd);
}

std::optional<Eigen::Vector2d> PhotoCamera::project(const Vec3& world) const {
  const Vec3 point = camera_from_world * world;
  if (point.z() <= 1e-6) return {};
  return lens.pixel_of(point.head<2>() / point.z());
}

Vec3 PhotoCamera::ray(const Eigen::Vector2d& pixel) const {
  return camera_from_world.rotation.conjugate() *
         lens.direction_of(pixel).homogeneous().normalized();
}

geometry::Rigid3 looking_at(const Vec3& centre, const Vec3& target) {
  const Vec3 z = (target - centre).normalized();
  Vec3 x = z.cross(Vec3::UnitZ());
  if (x.norm() < 1e-9) x = Vec3::UnitX();  // from straight above
  x.normalize();
  Eigen::Matrix3d rows;
  rows << x.transpose(), z.cross(x).transpose(), z.transpose();
  const Quat rotation(rows);
  return {rotation, -(rotation * centre)};
}

}  // namespace palmar::capture
