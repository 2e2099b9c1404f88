// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "hands/capture/photo/photo_camera.h"
#include "hands/capture/photo/photo_view.h"
#include "hands/capture/picture_vectors.h"
#include "hands/capture/sheet/hand_outline.h"
#include "palmar/core/parallel.h"

// Drawn photographs of a flat hand, for tests.

namespace palmar::capture {

/// A flat hand made of strips with round ends on an A4 sheet, seen by a pinhole: what it measures
/// is what it is drawn with.
struct DrawnHand {
  struct Strip {
    Vec2 from, to;
    double radius;
  };
  std::vector<Strip> fingers;                      // thumb to little
  double left = -40.0, right = 40.0, top = -55.0;  // the palm, from the sheet's lower edge
  double bottom = -200.0;

  DrawnHand() {
    const double lengths[] = {62.0, 70.0, 64.0, 50.0}, angle[] = {-0.22, -0.06, 0.08, 0.26};
    fingers.push_back({{-30.0, -115.0}, {-82.0, -85.0}, 9.0});
    for (int f = 0; f < 4; ++f) {
      const Vec2 from(-31.0 + 20.5 * f, top - 12.0);
      fingers.push_back(
          {from, from + (lengths[f] + 12.0) * Vec2(std::sin(angle[f]), std::cos(angle[f])), 7.5});
    }
  }
  bool covers(const Vec2& p) const {
    if (p.x() > left && p.x() < right && p.y() > bottom && p.y() < top) return true;
    for (const Strip& s : fingers) {
      const Vec2 d = s.to - s.from;
      if ((2.0 * p - s.from - s.to).squaredNorm() > std::pow(d.norm() + 2.0 * s.radius, 2))
        continue;
      const double t = std::clamp((p - s.from).dot(d) / d.squaredNorm(), 0.0, 1.0);
      if ((p - s.from - t * d).norm() < s.radius) return true;
    }
    return false;
  }
};

struct Scene {
  DrawnHand hand;
  Vec2 half{105.0, 148.5};
  std::array<int, 3> table{70, 60, 55}, skin{205, 150, 125};
  double tilt = 12.0, about = -80.0, distance = 460.0, focal = 0.74;
  int width = 600, height = 800;
  int side = 2;  ///< points of a pixel along an edge
  bool has_hand = true;
  std::optional<Vec2> card;   ///< the middle of a bank card on the table instead of the paper
  double card_turn = 0.0;     ///< deg
  Vec2 other_card{1e4, 0.0};  ///< the middle of a second one, as it lies
  std::array<int, 3> card_colour{40, 70, 150};
  std::array<double, 2> card_size{85.60, 53.98};

  PhotoCamera camera() const {
    PhotoCamera camera;
    const double f = focal * height, t = tilt * std::numbers::pi / 180.0,
                 a = about * std::numbers::pi / 180.0;
    camera.lens = {width, height, f, f, 0.5 * (width - 1), 0.5 * (height - 1), 0.0, 0.0};
    camera.camera_from_world = looking_at(
        distance * Vec3(std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), std::cos(t)),
        Vec3::Zero());
    return camera;
  }
  static constexpr double kCardFace = 0.76;  // mm, above the table: ISO/IEC 7810
  bool is_on_card(const Vec3& p, const Vec2& middle) const {
    const Vec2 q =
        Eigen::Rotation2Dd(-card_turn * std::numbers::pi / 180.0) * (p.head<2>() - middle);
    constexpr double kCorner = 3.18;
    const Vec2 out(std::abs(q.x()) - 0.5 * card_size[0] + kCorner,
                   std::abs(q.y()) - 0.5 * card_size[1] + kCorner);
    return out.maxCoeff() < kCorner && out.cwiseMax(0.0).norm() < kCorner;
  }
  geometry::RgbImage taken() const {
    const PhotoCamera at = camera();
    const Vec3 eye = at.centre();
    geometry::RgbImage image{width, height, {}};
    image.rgb.resize(3 * static_cast<std::size_t>(width) * height);
    parallel_for(height, [&](int y) {
      for (int x = 0; x < width; ++x) {
        std::array<double, 3> sum{};
        for (int s = 0; s < side * side; ++s) {
          const Vec3 ray =
              at.ray({x + (s % side + 0.5) / side - 0.5, y + (s / side + 0.5) / side - 0.5});
          const Vec3 p = eye - eye.z() / ray.z() * ray;
          const bool paper = !card && std::abs(p.x()) < half.x() && std::abs(p.y()) < half.y();
          std::array<int, 3> colour = paper ? std::array<int, 3>{226, 224, 220} : table;
          const Vec3 face = eye - (eye.z() - kCardFace) / ray.z() * ray;
          if (card && (is_on_card(face, *card) || is_on_card(face, other_card))) {
            colour = card_colour;
          }
          if (has_hand && hand.covers(p.head<2>())) colour = skin;
          for (std::size_t c = 0; c < 3; ++c)
            sum[c] += static_cast<double>(colour[c]) / (side * side);
        }
        for (std::size_t c = 0; c < 3; ++c) {
          image.rgb[pixel_offset(image, x, y) + c] = static_cast<std::uint8_t>(sum[c] + 0.5);
        }
      }
    });
    return image;
  }
};

/// Proportions of that hand, which has no height.
inline OutlineProportions flat_proportions() {
  OutlineProportions p;
  for (auto& segment : p.segment) segment = {0.4, 0.3, 0.3};
  p.segment[0] = {0.15, 0.15, 0.0};
  return p;
}

}  // namespace palmar::capture
