// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Simple hands and products with known answers, for the tests of this module.

#include <algorithm>
#include <memory>
#include <span>
#include <utility>

#include "palmar/geometry/distance/distance_field.h"
#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/hand/hand.h"

namespace palmar::contact::contact_test {

/// Solid below z = height.
class HalfSpace : public geometry::DistanceField {
 public:
  explicit HalfSpace(double height) : height_(height) {}
  void sample(std::span<const Vec3> points, double range,
              std::span<geometry::DistanceSample> samples) const override {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double d = points[i].z() - height_;
      samples[i] = {d, points[i] - d * Vec3::UnitZ(), Vec3::UnitZ(), -1};
      if (d > range) samples[i] = {range, points[i], Vec3::UnitZ(), -1};
      if (d < -range) samples[i] = {-range, points[i], Vec3::UnitZ(), -1};
    }
  }
  Box3 bounding_box() const override {
    return {Vec3(-1e3, -1e3, height_ - 1e3), Vec3(1e3, 1e3, height_)};
  }

 private:
  double height_;
};

/// Solid between two heights: a sheet.
class Sheet : public geometry::DistanceField {
 public:
  Sheet(double lower, double upper) : lower_(lower), upper_(upper) {}
  void sample(std::span<const Vec3> points, double /*range*/,
              std::span<geometry::DistanceSample> samples) const override {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double above = points[i].z() - upper_;
      const double below = lower_ - points[i].z();
      const bool top = above > below;
      const double d = std::max(above, below);
      const Vec3 n = top ? Vec3(Vec3::UnitZ()) : Vec3(-Vec3::UnitZ());
      samples[i] = {d, points[i] - d * n, n, -1};
    }
  }
  Box3 bounding_box() const override { return {Vec3(-1e3, -1e3, lower_), Vec3(1e3, 1e3, upper_)}; }

 private:
  double lower_, upper_;
};

/// Solid sphere.
class Ball : public geometry::DistanceField {
 public:
  Ball(Vec3 centre, double radius) : centre_(std::move(centre)), radius_(radius) {}
  void sample(std::span<const Vec3> points, double /*range*/,
              std::span<geometry::DistanceSample> samples) const override {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3 from_centre = points[i] - centre_;
      const Vec3 n = from_centre.normalized();
      samples[i] = {from_centre.norm() - radius_, centre_ + radius_ * n, n, -1};
    }
  }
  Box3 bounding_box() const override {
    return {centre_.array() - radius_, centre_.array() + radius_};
  }

 private:
  Vec3 centre_;
  double radius_;
};

/// A ball of skin about the origin whose lower half (z < 0) is one palmar region, the rest dorsum.
inline std::shared_ptr<hand::Hand> ball_hand(double radius, int subdivisions,
                                             hand::Region region = hand::Region::kMiddleDistal) {
  auto hand = std::make_shared<hand::Hand>();
  hand->name = "ball";
  hand->skin = geometry::make_icosphere(radius, subdivisions);
  for (const Vec3& v : hand->skin.vertices) {
    hand->region.push_back(v.z() < 0.0 ? region : hand::Region::kDorsum);
  }
  hand->segment.assign(hand->skin.vertices.size(), hand::Segment::kMiddleDistal);
  hand->tissue = hand::default_tissue();
  return hand;
}

}  // namespace palmar::contact::contact_test
