// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "palmar/hand/dimensions/hand_dimension.h"
#include "palmar/population/population.h"

namespace palmar::population {

/// One person of a population: what the hand measures, and what is known of its owner.
struct HandSample {
  std::string label;    ///< "17", "P5 woman", "95 % ellipse, 45 deg"
  std::string stratum;  ///< name of the stratum
  std::optional<grasp::Sex> sex;
  std::optional<double> age;                     ///< years
  std::vector<hand::SizedDimension> dimensions;  ///< driving and regressed ones, mm; a fixed order
  double grip_strength = 0.0;                    ///< N, of a dynamometer; 0: not known
};

enum class SamplingDesign {
  kRandom,          ///< independent draws
  kLatinHypercube,  ///< what the driving dimensions are made of in equal-probability layers
  kBoundary,        ///< mean and points of an ellipse of two driving dimensions
  kPercentiles      ///< hands whose driving dimensions all stand at a percentile of their stratum
};
inline constexpr std::array kSamplingDesigns{
    SamplingDesign::kRandom, SamplingDesign::kLatinHypercube, SamplingDesign::kBoundary,
    SamplingDesign::kPercentiles};
/// "random", "latin_hypercube", "boundary", "percentiles".
std::string name_of(SamplingDesign design);
std::optional<SamplingDesign> sampling_design_named(std::string_view name);  ///< "lhs", too

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

/// Hands of a population. Throws UsageError for a bad population or bad options.
/// - kRandom: hand k comes from stream k of the seed alone, so it is the same whatever the number
///   of other hands.
/// - kLatinHypercube: strata get hands by their shares; within one, independent factors (Cholesky
///   factor of the correlation, in the order of the driving dimensions) have one hand in each of n
///   layers (McKay, Beckman, Conover 1979), in an order that leaves them hardly correlated (Iman &
///   Conover 1982). The first driving dimension thus has a hand in each of its own layers, the
///   means of the others scatter as little, and few hands have the population's correlations.
/// - kBoundary: of every stratum its mean and points on the ellipse of its first two driving
///   dimensions that holds the stated share of people (chi-square, 2 degrees of freedom). In
///   standard scores its axes are "both larger" (0 deg) and "the second larger, the first smaller"
///   (90 deg); other driving dimensions are the mean given the two.
/// - kPercentiles: every driving dimension at the percentile, which as a whole is rarer than its
///   name says.
/// Residuals are drawn in the first two only. Grip strength: mean and deviation by sex and age
/// (joint_strength.h), independent of hand size; the mean in the last two.
std::vector<HandSample> sample_hands(const Population& population, const SamplingOptions& options);

}  // namespace palmar::population
