// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/imaging/denoise.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "hands/imaging/air_threshold.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/statistics/median.h"

namespace palmar::imaging {
namespace {

/// Flow between two voxels of difference `s`: Tukey's biweight, with scale = 1 / K^2.
inline float flow(float s, float scale) {
  const float rest = std::max(0.0F, 1.0F - s * s * scale);
  return s * rest * rest;
}

/// One row of the next image. `weight`: share of a step along i, j, k.
void diffuse_row(const Volume& from, Volume& to, int j, int k, const std::array<float, 3>& weight,
                 float scale) {
  const VolumeGrid& grid = from.grid;
  const auto width = static_cast<std::size_t>(grid.size[0]);
  // At the border the image goes on as it is: nothing flows.
  const auto row = [&](int dj, int dk) {
    const int jj = std::clamp(j + dj, 0, grid.size[1] - 1);
    const int kk = std::clamp(k + dk, 0, grid.size[2] - 1);
    return from.value.data() + grid.at(0, jj, kk);
  };
  const float* here = row(0, 0);
  const float* back = row(-1, 0);
  const float* front = row(1, 0);
  const float* below = row(0, -1);
  const float* above = row(0, 1);
  float* result = to.value.data() + grid.at(0, j, k);
  for (std::size_t i = 0; i < width; ++i) {
    const float v = here[i];
    const float y = flow(back[i] - v, scale) + flow(front[i] - v, scale);
    const float z = flow(below[i] - v, scale) + flow(above[i] - v, scale);
    result[i] = v + weight[1] * y + weight[2] * z;
  }
  for (std::size_t i = 0; i + 1 < width; ++i) {
    const float x = weight[0] * flow(here[i + 1] - here[i], scale);
    result[i] += x;
    result[i + 1] -= x;
  }
}

}  // namespace

void DenoiseOptions::check() const {
  if (iterations < 0 || iterations > 1000) {
    throw UsageError("denoising: " + std::to_string(iterations) +
                     " iterations; 0 to 1000 are allowed");
  }
  if (!(edge > 0.0 && edge <= 1000.0)) {
    throw UsageError("denoising: edge is " + std::to_string(edge) +
                     " deviations of the noise; above 0 and up to 1000 are allowed");
  }
}

double noise_deviation(const Volume& image) {
  const VolumeGrid& grid = image.grid;
  const double air = air_threshold(image);
  // Every row gives its own samples; few are enough for a median.
  constexpr std::size_t kSamples = 2'000'000;
  const std::size_t step = std::max<std::size_t>(1, grid.count() / kSamples);
  std::vector<float> difference;
  const auto width = static_cast<std::size_t>(grid.size[0]);
  for (std::size_t v = 0; v < grid.count(); v += step) {
    const std::size_t i = v % width;
    if (i == 0 || i + 1 >= width) continue;
    const float a = image.value[v - 1];
    const float b = image.value[v];
    const float c = image.value[v + 1];
    if (std::min({a, b, c}) <= air) continue;
    difference.push_back(std::abs(a - 2.0F * b + c));
  }
  if (difference.empty()) return 0.0;
  // The median of |x| is 0.6745 deviations; 1 - 2 + 1 has sqrt(6) times the noise's.
  return statistics::median(std::move(difference)) / (0.6744897501960817 * std::sqrt(6.0));
}

Volume denoised(const Volume& image, const DenoiseOptions& options, const Progress& progress) {
  options.check();
  const double noise = noise_deviation(image);
  Volume from = image;
  if (!(noise > 0.0)) return from;
  const double cut = options.edge * noise;
  // Largest stable step: 1 / (2 sum of h_min^2 / h_a^2); a tenth less.
  const Vec3 ratio =
      (image.grid.spacing.minCoeff() * image.grid.spacing.cwiseInverse()).cwiseAbs2();
  const double step = 0.9 / (2.0 * ratio.sum());
  std::array<float, 3> weight{};
  for (int a = 0; a < 3; ++a) {
    weight[a] = static_cast<float>(step * ratio[a]);
  }
  const auto scale = static_cast<float>(1.0 / (cut * cut));
  Volume to = from;
  for (int n = 0; n < options.iterations; ++n) {
    progress.update(static_cast<double>(n) / options.iterations, "smoothing within tissues");
    parallel_for(image.grid.size[2], [&](int k) {
      for (int j = 0; j < image.grid.size[1]; ++j) diffuse_row(from, to, j, k, weight, scale);
    });
    std::swap(from, to);
  }
  return from;
}

}  // namespace palmar::imaging
