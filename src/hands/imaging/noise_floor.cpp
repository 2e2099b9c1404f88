// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/imaging/noise_floor.h"

#include <cmath>

namespace palmar::imaging {

double without_noise_floor(double magnitude, double sigma) {
  const double square = magnitude * magnitude - 2.0 * sigma * sigma;
  return std::copysign(std::sqrt(std::abs(square)), square);
}

Volume without_noise_floor(Volume image, double sigma) {
  if (!(sigma > 0.0)) return image;
  for (float& value : image.value) {
    value = static_cast<float>(without_noise_floor(static_cast<double>(value), sigma));
  }
  return image;
}

double with_noise_floor(double signal, double sigma) {
  return std::sqrt(signal * signal + 2.0 * sigma * sigma);
}

}  // namespace palmar::imaging
