// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "hands/phantom/person/person_random.h"
#include "palmar/core/random.h"
#include "palmar/geometry/types.h"

namespace palmar::phantom {

/// Smooth noise in space: 24 cosines in random directions, wavelengths from 0.7 to 1.3 of that
/// given [mm]; mean 0, variance 1.
class SmoothNoise {
 public:
  SmoothNoise(std::uint64_t seed, std::uint64_t stream, double wavelength) {
    constexpr double kTurn = 2.0 * std::numbers::pi;
    RandomStream random(seed, stream);
    for (Wave& w : wave_) {
      const Vec3 way = normal_vector(random);
      w.k = way.normalized() * (kTurn / (wavelength * (0.7 + 0.6 * random.uniform())));
      w.phase = kTurn * random.uniform();
    }
  }
  double at(const Vec3& p) const {
    double sum = 0.0;
    for (const Wave& w : wave_) sum += std::cos(w.k.dot(p) + w.phase);
    return sum * std::sqrt(2.0 / kCount);
  }

 private:
  static constexpr int kCount = 24;
  struct Wave {
    Vec3 k = Vec3::Zero();
    double phase = 0.0;
  };
  std::array<Wave, kCount> wave_;
};

}  // namespace palmar::phantom
