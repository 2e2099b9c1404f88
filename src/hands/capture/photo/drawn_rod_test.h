// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "hands/capture/photo/photo_camera.h"
#include "hands/capture/photo/photo_view.h"
#include "palmar/core/parallel.h"
#include "palmar/core/random.h"

// Drawn photographs of a round rod, for tests.

namespace palmar::capture {

/// An upright rod as thick as a finger with a half ball on top, on z = 0 before a blue backdrop:
/// uneven skin, two lamps, noise of a sensor. Rays are cut with it in closed form.
struct DrawnRod {
  double radius = 8.0, top = 60.0;  ///< mm
  double texture = 0.1;             ///< unevenness of the skin, share
  double noise = 4.0;               ///< steps of 255
  double gloss = 0.0;               ///< mirrored lamps, share of white

  double ball() const { return top - radius; }
  /// How far a point is outside of it, mm.
  double distance(const Vec3& p) const {
    if (p.z() < ball()) return p.head<2>().norm() - radius;
    return (p - Vec3(0, 0, ball())).norm() - radius;
  }
  std::optional<double> hit(const Vec3& from, const Vec3& ray) const {
    const auto first = [&](const Vec3& o, const Vec3& d) {
      const double a = d.squaredNorm(), b = o.dot(d), c = o.squaredNorm() - radius * radius;
      return b * b > a * c ? (-b - std::sqrt(b * b - a * c)) / a : -1.0;
    };
    const double side = first({from.x(), from.y(), 0}, {ray.x(), ray.y(), 0});
    const double end = first(from - Vec3(0, 0, ball()), ray);
    const double z = (from + side * ray).z();
    if (side > 0.0 && z > 0.0 && z < ball()) return side;
    if (end > 0.0 && (from + end * ray).z() >= ball()) return end;
    return {};
  }
  Vec3 normal(const Vec3& p) const {
    return Vec3(p.x(), p.y(), std::max(0.0, p.z() - ball())).normalized();
  }

  /// Smooth noise about 0, one swell per unit.
  static double swell(const Vec3& at, std::uint32_t seed) {
    const Eigen::Vector3i low = at.array().floor().cast<int>();
    const Vec3 t = at - low.cast<double>();
    double sum = 0.0;
    for (int n = 0; n < 8; ++n) {
      double share = 1.0;
      std::array<std::uint32_t, 4> place{0, 0, 0, seed};
      for (int a = 0; a < 3; ++a) {
        const int high = (n >> a) & 1;
        const double f = t[a] * t[a] * (3.0 - 2.0 * t[a]);
        share *= high != 0 ? f : 1.0 - f;
        place[static_cast<std::size_t>(a)] = static_cast<std::uint32_t>(low[a] + high);
      }
      sum += share * (static_cast<double>(philox(place, {1, 1})[0]) * 0x1p-31 - 1.0);
    }
    return sum;
  }
  static double grain(const Vec3& p) {
    double sum = 0.0, size = 0.6;  // mm
    for (std::uint32_t octave = 0; octave < 5; ++octave, size *= 2.0)
      sum += swell(p / size, octave);
    return 1.3 * sum;
  }

  Eigen::Vector3d light(const Vec3& eye, const Vec3& ray) const {
    const auto t = hit(eye, ray);
    if (!t) return {30.0, 70.0, 160.0};
    const Vec3 p = eye + *t * ray, n = normal(p);
    const std::array<Vec3, 2> lamps = {Vec3(0.4, -0.5, 0.75).normalized(),
                                       Vec3(-0.7, 0.35, 0.6).normalized()};
    const Vec3 mirrored = ray - 2.0 * ray.dot(n) * n;
    double own = 0.45, shine = 0.0, strength = 0.45;
    for (const Vec3& lamp : lamps) {
      own += strength * std::max(0.0, n.dot(lamp));
      shine += 255.0 * gloss * strength / 0.45 * std::pow(std::max(0.0, mirrored.dot(lamp)), 20);
      strength = 0.3;
    }
    own *= std::max(0.2, 1.0 + texture * grain(p));
    return own * Eigen::Vector3d(215.0, 165.0, 140.0) + Eigen::Vector3d::Constant(shine);
  }

  geometry::RgbImage taken(const PhotoCamera& camera, std::uint32_t number) const {
    geometry::RgbImage image{camera.lens.width, camera.lens.height, {}};
    image.rgb.resize(3 * static_cast<std::size_t>(image.width) * image.height);
    const Vec3 eye = camera.centre();
    parallel_for(image.height, [&](int y) {
      for (int x = 0; x < image.width; ++x) {
        constexpr int kSide = 2;
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (int s = 0; s < kSide * kSide; ++s) {
          sum += light(eye, camera.ray({x + (s % kSide + 0.5) / kSide - 0.5,
                                        y + (s / kSide + 0.5) / kSide - 0.5})) /
                 (kSide * kSide);
        }
        const auto bits = philox(
            {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), number, 7}, {2, 2});
        for (std::size_t c = 0; c < 3; ++c) {
          // Even over +- sqrt(3) deviations.
          const double even = static_cast<double>(bits[c]) * 0x1p-31 - 1.0;
          const double value = sum[static_cast<int>(c)] + std::sqrt(3.0) * noise * even + 0.5;
          image.rgb[pixel_offset(image, x, y) + c] =
              static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0));
        }
      }
    });
    return image;
  }

  /// Photographs from all round, at the heights by turns; a pixel covers `pixel` mm.
  std::vector<Photograph> photographs(int count, const std::vector<double>& heights,
                                      double pixel) const {
    constexpr double kDistance = 455.0, kDegrees = std::numbers::pi / 180.0;
    const Vec3 middle(0.0, 0.0, 0.5 * top + 2.0);
    std::vector<Photograph> result;
    for (int i = 0; i < count; ++i) {
      Photograph one;
      one.name = "rod " + std::to_string(i);
      const auto width = static_cast<int>(44.0 / pixel), height = static_cast<int>(80.0 / pixel);
      one.camera.lens = {.width = width,
                         .height = height,
                         .focal_x = kDistance / pixel,
                         .focal_y = kDistance / pixel,
                         .centre_x = 0.5 * (width - 1),
                         .centre_y = 0.5 * (height - 1)};
      const double turn = 360.0 * i / count * kDegrees;
      const double up = heights[static_cast<std::size_t>(i) % heights.size()] * kDegrees;
      one.camera.camera_from_world =
          looking_at(middle + kDistance * Vec3(std::cos(turn) * std::cos(up),
                                               std::sin(turn) * std::cos(up), std::sin(up)),
                     middle);
      one.image = taken(one.camera, static_cast<std::uint32_t>(i));
      result.push_back(std::move(one));
    }
    return result;
  }
};

}  // namespace palmar::capture
