// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "palmar/hand/hand_dimension.h"
#include "palmar/population/population.h"

namespace palmar {

/// One person of a population: what the hand measures, and what is known of its owner.
struct HandSample {
  std::string label;    ///< "17", "P5 woman", "95 % ellipse, 45 deg"
  std::string stratum;  ///< name of the stratum
  std::optional<Sex> sex;
  std::optional<double> age;               ///< years
  std::vector<SizedDimension> dimensions;  ///< driving and regressed ones, mm; a fixed order
  double grip_strength = 0.0;              ///< N, of a dynamometer; 0: not known
};

enum class SamplingDesign {
  kRandom,          ///< independent draws
  kLatinHypercube,  ///< every driving dimension in equal-probability layers
  kBoundary,        ///< mean and points of an ellipse of two driving dimensions
  kPercentiles      ///< hands whose driving dimensions all stand at a percentile of their stratum
};

struct SamplingOptions {
  SamplingDesign design = SamplingDesign::kLatinHypercube;
  int hands = 30;  ///< kRandom, kLatinHypercube
  std::uint64_t seed = 1;
  bool residuals = true;                          ///< residual variation round the regressions
  double boundary = 0.95;                         ///< kBoundary: share of people inside the ellipse
  int boundary_points = 8;                        ///< kBoundary: on the ellipse, beside the mean
  std::vector<double> percentiles = {5, 50, 95};  ///< kPercentiles, of every stratum
  void check() const;  ///< throws UsageError: field, value, allowed range
};

/// Hand k is the same whatever the number of threads or of other hands (kRandom).
std::vector<HandSample> sample_hands(const Population& population, const SamplingOptions& options);

}  // namespace palmar
