// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/imaging/bias_field.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "hands/imaging/air_threshold.h"
#include "hands/imaging/histogram_sharpening.h"
#include "hands/imaging/smooth_field.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/statistics/median.h"

namespace palmar::imaging {
namespace {

[[noreturn]] void refuse(const char* field, double value, const char* allowed) {
  throw UsageError(std::string("bias field: ") + field + " is " + std::to_string(value) + "; " +
                   allowed);
}

/// Where the field is looked for: medians over blocks of voxels that are mostly tissue. A mean
/// would mix tissues, more of them in the fingers than in the palm, which would pass for a field.
struct Samples {
  std::vector<Vec3> place;  ///< in [0, 1] along i, j, k of the image
  std::vector<double> log_value;
};

/// Place of voxel `index` in [0, 1].
double share_of(double index, int size) { return size > 1 ? index / (size - 1.0) : 0.5; }

Samples samples_of(const Volume& image, const std::vector<std::uint8_t>& mask, double air,
                   double spacing) {
  const VolumeGrid& grid = image.grid;
  std::array<int, 3> block{};
  std::array<int, 3> blocks{};
  for (std::size_t a = 0; a < 3; ++a) {
    const double ratio = spacing / grid.spacing[static_cast<Eigen::Index>(a)];
    block[a] = std::clamp(static_cast<int>(std::lround(ratio)), 1, grid.size[a]);
    blocks[a] = (grid.size[a] + block[a] - 1) / block[a];
  }
  Samples samples;
  for (int bk = 0; bk < blocks[2]; ++bk) {
    for (int bj = 0; bj < blocks[1]; ++bj) {
      for (int bi = 0; bi < blocks[0]; ++bi) {
        std::vector<float> values;
        int all = 0;
        Vec3 place = Vec3::Zero();
        const std::array<int, 3> start = {bi * block[0], bj * block[1], bk * block[2]};
        for (int k = start[2]; k < std::min(start[2] + block[2], grid.size[2]); ++k) {
          for (int j = start[1]; j < std::min(start[1] + block[1], grid.size[1]); ++j) {
            for (int i = start[0]; i < std::min(start[0] + block[0], grid.size[0]); ++i) {
              const std::size_t v = grid.at(i, j, k);
              ++all;
              const bool is_in = mask.empty() ? image.value[v] > air : mask[v] != 0;
              if (!is_in) continue;
              values.push_back(image.value[v]);
              place += Vec3(i, j, k);
            }
          }
        }
        if (2 * static_cast<int>(values.size()) < all) continue;
        const float middle = statistics::median(values);
        if (!(middle > 0.0F)) continue;
        place /= static_cast<double>(values.size());
        for (int a = 0; a < 3; ++a) {
          place[a] = share_of(place[a], grid.size[a]);
        }
        samples.place.push_back(place);
        samples.log_value.push_back(std::log(static_cast<double>(middle)));
      }
    }
  }
  return samples;
}

/// How much two logarithmic fields differ: the coefficient of variation of their ratio.
double change_of(const std::vector<double>& log_ratio) {
  double mean = 0.0;
  double square = 0.0;
  for (const double value : log_ratio) {
    mean += std::exp(value);
    square += std::exp(2.0 * value);
  }
  const auto count = static_cast<double>(log_ratio.size());
  mean /= count;
  return std::sqrt(std::max(0.0, square / count - mean * mean)) / mean;
}

}  // namespace

void BiasFieldOptions::check() const {
  if (!(shrunk_spacing > 0.0 && shrunk_spacing <= 100.0)) {
    refuse("shrunk spacing, mm,", shrunk_spacing, "above 0 and up to 100 is allowed");
  }
  if (levels < 1 || levels > 6) refuse("number of levels", levels, "1 to 6 are allowed");
  if (iterations < 1 || iterations > 1000) refuse("iterations", iterations, "1 to 1000");
  if (!(tolerance > 0.0 && tolerance < 1.0)) refuse("tolerance", tolerance, "0 to 1 is allowed");
  if (!(width > 0.0 && width <= 2.0)) refuse("width", width, "above 0 and up to 2 is allowed");
  if (!(noise > 0.0 && noise <= 1.0)) refuse("noise", noise, "above 0 and up to 1 is allowed");
  if (bins < 20 || bins > 2000) refuse("number of bins", bins, "20 to 2000 are allowed");
}

Volume corrected_for_bias(const Volume& image, const std::vector<std::uint8_t>& mask,
                          const BiasFieldOptions& options, const Progress& progress) {
  options.check();
  const VolumeGrid& grid = image.grid;
  if (!mask.empty() && mask.size() != grid.count()) {
    throw UsageError("bias field: the mask has " + std::to_string(mask.size()) + " voxels; " +
                     std::to_string(grid.count()) + " are required");
  }
  const Samples samples =
      samples_of(image, mask, mask.empty() ? air_threshold(image) : 0.0, options.shrunk_spacing);
  if (samples.place.empty()) throw InputError("bias field: the image shows no tissue");

  std::vector<SmoothField> levels;
  std::vector<double> corrected = samples.log_value;
  for (int level = 0; level < options.levels; ++level) {
    SmoothField field(1 << level);
    const SmoothFieldFit fit(field, samples.place);
    for (int n = 0; n < options.iterations; ++n) {
      progress.update((level + static_cast<double>(n) / options.iterations) / options.levels,
                      "evening out the image's brightness");
      const std::vector<double> sharp =
          sharpened(corrected, {options.width, options.noise, options.bins});
      std::vector<double> rest(corrected.size());
      for (std::size_t s = 0; s < rest.size(); ++s) rest[s] = corrected[s] - sharp[s];
      const std::vector<double> update = fit.add_to(field, rest);
      for (std::size_t s = 0; s < rest.size(); ++s) corrected[s] -= update[s];
      if (change_of(update) < options.tolerance) break;
    }
    levels.push_back(std::move(field));
  }
  // The level of intensities stays: the field's mean logarithm over the samples is 0.
  double mean = 0.0;
  for (std::size_t s = 0; s < corrected.size(); ++s) mean += samples.log_value[s] - corrected[s];
  mean /= static_cast<double>(corrected.size());

  Volume result = image;
  parallel_for(grid.size[2], [&](int k) {
    std::vector<SmoothField::Plane> planes;
    const double w = share_of(k, grid.size[2]);
    for (const SmoothField& field : levels) planes.push_back(field.plane(w));
    for (int j = 0; j < grid.size[1]; ++j) {
      std::vector<SmoothField::Line> lines;
      for (const auto& plane : planes) lines.push_back(plane.line(share_of(j, grid.size[1])));
      for (int i = 0; i < grid.size[0]; ++i) {
        const double u = share_of(i, grid.size[0]);
        double log_field = -mean;
        for (const auto& line : lines) log_field += line.at(u);
        float& value = result.value[grid.at(i, j, k)];
        value = static_cast<float>(value * std::exp(-log_field));
      }
    }
  });
  return result;
}

}  // namespace palmar::imaging
