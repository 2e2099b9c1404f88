// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "palmar/grasp/joint_strength.h"
#include "palmar/hand/dimensions/hand_dimension.h"

namespace palmar::population {

/// How a dimension of a population is known.
enum class Evidence {
  kMeasured,   ///< on the people themselves
  kRegressed,  ///< from measured dimensions, by a regression found on these or other people
  kScaled      ///< in the template's proportions
};
std::string name_of(Evidence evidence);  ///< "measured", "regressed", "scaled"
std::optional<Evidence> evidence_named(std::string_view name);

/// One dimension of the joint normal distribution.
struct DrivingDimension {
  hand::HandDimension dimension;
  double mean = 0.0;  ///< mm
  double sd = 0.0;    ///< mm; 0: only the mean is known
  std::string source;
  Evidence evidence = Evidence::kMeasured;  ///< kScaled: in part borrowed from other people
};

/// y = intercept + sum_k slope_k x_k + residual; residual normal with the given deviation,
/// independent of everything else. The x are driving dimensions or ones regressed before.
struct DimensionRegression {
  hand::HandDimension dimension;
  double intercept = 0.0;  ///< mm
  struct Term {
    hand::HandDimension predictor;
    double slope = 0.0;  ///< mm per mm
  };
  std::vector<Term> terms;
  double residual_sd = 0.0;  ///< mm
  Evidence evidence = Evidence::kRegressed;
  std::string source;
};

/// People that one normal distribution describes: one sex, usually.
struct Stratum {
  std::string name;               ///< "women"
  std::optional<grasp::Sex> sex;  ///< nothing: mixed or unknown
  double share = 1.0;             ///< of the population
  std::optional<double> age;      ///< mean, years; for grip strength
  std::vector<DrivingDimension> driving;
  Eigen::MatrixXd correlation;  ///< of `driving`, symmetric, unit diagonal, positive definite
  std::vector<DimensionRegression> regressions;
};

/// What is wrong with a stratum by itself (numbers, names, correlation), naming dimension, value
/// and what is allowed; empty if nothing is. Means lie within 1 to 400 mm, deviations below a fifth
/// of the mean, so that no hand gets a length of nothing.
std::string fault_of(const Stratum& stratum);

/// Mean and standard deviation [mm] of a dimension over a stratum, as the model has them; nothing
/// if it neither drives nor is regressed.
struct DimensionMoments {
  double mean = 0.0, sd = 0.0;
};
std::optional<DimensionMoments> moments_of(const Stratum& stratum, hand::HandDimension dimension);

/// Whose hands: a mixture of strata. Dimensions that neither drive nor are regressed follow in the
/// template's proportions (make_hand_instance()).
struct Population {
  std::string name;   ///< "ansur2_women"; as on the command line
  std::string title;  ///< for people
  std::vector<Stratum> strata;
  std::string source;
  std::vector<std::string> cautions;  ///< reported with every result: mixed sexes, means only ...
  void check() const;  ///< throws UsageError: stratum, dimension, value, what is allowed
};

/// What is wrong with a population apart from its strata's own faults; empty if nothing is.
std::string fault_of(const Population& population);

}  // namespace palmar::population
