// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/distance/distance_field.h"

#include <atomic>
#include <limits>

namespace palmar::geometry {
namespace {

std::uint64_t next_id() {
  static std::atomic<std::uint64_t> last = 0;
  return ++last;
}

}  // namespace

DistanceField::DistanceField() : id_(next_id()) {}
DistanceField::DistanceField(const DistanceField&) : id_(next_id()) {}
DistanceField& DistanceField::operator=(const DistanceField&) {
  id_ = next_id();
  return *this;
}

void DistanceField::resample(std::span<const Vec3> points, double range,
                             std::span<DistanceSample> samples) const {
  sample(points, range, samples);
}

DistanceSample DistanceField::at(const Vec3& point) const {
  DistanceSample result;
  sample({&point, 1}, std::numeric_limits<double>::infinity(), {&result, 1});
  return result;
}

DistanceSample DistanceField::at(const Vec3& point, const DistanceSample& near) const {
  DistanceSample result = near;
  resample({&point, 1}, std::numeric_limits<double>::infinity(), {&result, 1});
  return result;
}

}  // namespace palmar::geometry
