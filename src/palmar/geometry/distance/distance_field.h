// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "palmar/geometry/types.h"

namespace palmar::geometry {

/// What a distance field says about one point.
struct DistanceSample {
  double distance = 0.0;        ///< signed distance to the surface, mm; negative inside
  Vec3 closest = Vec3::Zero();  ///< nearest point of the surface, mm
  Vec3 normal = Vec3::UnitZ();  ///< unit outward gradient of the distance at the point
  int triangle = -1;  ///< nearest triangle of a mesh; -1 for analytic shapes or beyond range
};

/// Signed distance to the surface of a solid, in the solid's own frame. Implementations are
/// immutable after construction and may be queried from several threads at once.
class DistanceField {
 public:
  DistanceField();
  DistanceField(const DistanceField& other);
  DistanceField& operator=(const DistanceField& other);
  virtual ~DistanceField() = default;

  /// Different for every field ever made in this process: says whether samples kept from an
  /// earlier call are of this field.
  std::uint64_t id() const { return id_; }

  /// Samples every point. samples.size() must equal points.size(). Points farther than `range`
  /// [mm] from the surface may come back as distance = +range (outside) or -range (inside) with no
  /// closest point (triangle -1, closest = the point itself); that makes far queries cheap.
  virtual void sample(std::span<const Vec3> points, double range,
                      std::span<DistanceSample> samples) const = 0;

  /// The same for points whose samples, by this field, are known from before they moved a little:
  /// these come in in `samples` and are replaced. They save time and never change the answer.
  virtual void resample(std::span<const Vec3> points, double range,
                        std::span<DistanceSample> samples) const;

  /// The normal, at a sample of this field, of the surface that its facets stand for: unit; of a
  /// smooth shape the sample's own.
  virtual Vec3 smooth_normal(const DistanceSample& sample) const { return sample.normal; }

  /// Whether d(p) and d(q) never differ by more than |p - q|: true of exact distances to a closed
  /// surface; not where the side jumps in a hole, or of interpolated distances.
  virtual bool is_lipschitz() const { return false; }

  /// Box around the surface, mm.
  virtual Box3 bounding_box() const = 0;

  /// One point, unlimited range. Convenience over sample().
  DistanceSample at(const Vec3& point) const;
  /// The same, where the sample of a point near it is known: saves time, never changes the answer.
  DistanceSample at(const Vec3& point, const DistanceSample& near) const;

 private:
  std::uint64_t id_;
};

}  // namespace palmar::geometry
