// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/distance/scaled_distance.h"

namespace palmar::geometry {

std::vector<Vec3> ScaledDistance::from_here(std::span<const Vec3> points) const {
  std::vector<Vec3> there;
  there.reserve(points.size());
  for (const Vec3& p : points) there.push_back(from_here(p));
  return there;
}

void ScaledDistance::to_here(std::span<DistanceSample> samples) const {
  for (DistanceSample& s : samples) {
    s.distance *= factor_;
    s.closest = to_here(s.closest);
  }
}

void ScaledDistance::sample(std::span<const Vec3> points, double range,
                            std::span<DistanceSample> samples) const {
  field_->sample(from_here(points), range / factor_, samples);
  to_here(samples);
}

void ScaledDistance::resample(std::span<const Vec3> points, double range,
                              std::span<DistanceSample> samples) const {
  for (DistanceSample& s : samples) {
    s.distance /= factor_;
    s.closest = from_here(s.closest);
  }
  field_->resample(from_here(points), range / factor_, samples);
  to_here(samples);
}

Vec3 ScaledDistance::smooth_normal(const DistanceSample& sample) const {
  DistanceSample there = sample;
  there.distance /= factor_;
  there.closest = from_here(sample.closest);
  return field_->smooth_normal(there);
}

Box3 ScaledDistance::bounding_box() const {
  const Box3 box = field_->bounding_box();
  return box.isEmpty() ? box : Box3(to_here(box.min()), to_here(box.max()));
}

}  // namespace palmar::geometry
