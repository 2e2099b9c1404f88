// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/distance_field.h"

#include <limits>

namespace palmar {

void DistanceField::resample(std::span<const Vec3> points, double range,
                             std::span<DistanceSample> samples) const {
  sample(points, range, samples);
}

DistanceSample DistanceField::at(const Vec3& point) const {
  DistanceSample result;
  sample({&point, 1}, std::numeric_limits<double>::infinity(), {&result, 1});
  return result;
}

}  // namespace palmar
