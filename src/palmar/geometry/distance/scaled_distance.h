// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "palmar/geometry/distance/distance_field.h"

namespace palmar::geometry {

/// A solid scaled by a factor about a point: d'(p) = k d(c + (p - c) / k).
class ScaledDistance : public DistanceField {
 public:
  /// `factor`: above 0.
  ScaledDistance(std::shared_ptr<const DistanceField> field, const Vec3& centre, double factor)
      : field_(std::move(field)), centre_(centre), factor_(factor) {}

  void sample(std::span<const Vec3> points, double range,
              std::span<DistanceSample> samples) const override;
  void resample(std::span<const Vec3> points, double range,
                std::span<DistanceSample> samples) const override;
  Vec3 smooth_normal(const DistanceSample& sample) const override;
  bool is_lipschitz() const override { return field_->is_lipschitz(); }
  Box3 bounding_box() const override;

 private:
  Vec3 from_here(const Vec3& p) const { return centre_ + (p - centre_) / factor_; }
  Vec3 to_here(const Vec3& p) const { return centre_ + factor_ * (p - centre_); }
  std::vector<Vec3> from_here(std::span<const Vec3> points) const;
  void to_here(std::span<DistanceSample> samples) const;

  std::shared_ptr<const DistanceField> field_;
  Vec3 centre_;
  double factor_;
};

}  // namespace palmar::geometry
