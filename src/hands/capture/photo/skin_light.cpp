// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/photo/skin_light.h"

#include <algorithm>
#include <cmath>

namespace palmar::capture {
namespace {

float level_at(std::vector<float>& values, double share) {
  const auto at = values.begin() +
                  static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// The usual colour of a spot: of each channel the median.
Eigen::Vector3f usual_light(const std::vector<SkinSample>& spot) {
  Eigen::Vector3f usual;
  std::vector<float> channel(spot.size());
  for (int k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < spot.size(); ++i) channel[i] = spot[i].light[k];
    usual[k] = level_at(channel, 0.5);
  }
  return usual;
}

Eigen::Vector3f without_grey(const Eigen::Vector3f& light) {
  return light - Eigen::Vector3f::Constant(light.sum() / 3.0F);
}

/// What a sample has more than its own light, if it is brighter than usual as well; less, if it is
/// darker. A backdrop that shows at an outline makes skin paler and darker; it mirrors nothing.
float mirrored_light(float own, float all) {
  const float more = all - own;
  if (more > 0.0F && all > 1.0F) return std::min(more, all - 1.0F);
  if (more < 0.0F && all < 1.0F) return std::max(more, all - 1.0F);
  return 0.0F;
}

}  // namespace

SkinLight judge_skin_light(const std::vector<std::vector<SkinSample>>& spots) {
  constexpr std::size_t kFewSamples = 5, kFewSpots = 100;
  constexpr float kGrey = 0.08F;  // of the sum; light skin has 0.25
  SkinLight result;
  std::vector<float> mirrored;
  double covariance = 0.0, samples = 0.0;
  for (const std::vector<SkinSample>& spot : spots) {
    if (spot.size() < kFewSamples) continue;
    const Eigen::Vector3f usual = usual_light(spot);
    const Eigen::Vector3f colour = without_grey(usual);
    const float sum = usual.sum(), strength = colour.norm();
    if (!(strength > kGrey * sum)) continue;
    ++result.spots;
    double own_mean = 0.0, all_mean = 0.0;
    std::vector<std::pair<double, double>> own_and_all;
    for (const SkinSample& sample : spot) {
      const float own = without_grey(sample.light).dot(colour) / (strength * strength);
      const float all = sample.light.sum() / sum;
      mirrored.push_back(mirrored_light(own, all));
      own_and_all.emplace_back(own, all);
      own_mean += own;
      all_mean += all;
    }
    own_mean /= static_cast<double>(spot.size());
    all_mean /= static_cast<double>(spot.size());
    for (const auto& [own, all] : own_and_all) covariance += (own - own_mean) * (all - all_mean);
    samples += static_cast<double>(spot.size() - 1);
  }
  if (result.spots < kFewSpots) return {.spots = result.spots};
  constexpr double kTail = 0.02;
  const double bright = level_at(mirrored, 1.0 - kTail), dark = level_at(mirrored, kTail);
  result.gloss = std::max(0.0, bright + dark);
  result.change = std::sqrt(std::max(0.0, covariance / samples));
  return result;
}

}  // namespace palmar::capture
