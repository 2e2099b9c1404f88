// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "palmar/hand/dimensions/hand_dimension.h"
#include "palmar/population/population.h"

namespace palmar::population {

/// Something measured on a person: a dimension or a sum of several (a finger's length from web to
/// tip is that of its three segments), and how well.
struct KnownMeasure {
  std::vector<std::pair<hand::HandDimension, double>> terms;  ///< dimension, factor
  double value = 0.0;                                         ///< mm
  double sd = 0.0;                                            ///< of the measurement's error, mm
  std::string name;                                           ///< for messages

  static KnownMeasure of(hand::HandDimension dimension, double value, double sd);
};

/// One dimension of a person as population and measurements have it.
struct EstimatedDimension {
  hand::HandDimension dimension;
  double value = 0.0;  ///< mm
  double sd = 0.0;     ///< mm: about 95 of 100 such people lie within two of them
  bool is_measured = false;
  Evidence evidence = Evidence::kRegressed;  ///< how it follows if it isn't measured
};

struct PersonEstimate {
  std::vector<EstimatedDimension> dimensions;  ///< of the population, then the middle finger's
                                               ///< proximal length
  std::vector<double> stratum_share;           ///< how likely the person belongs to each stratum
  std::vector<std::string> notes;              ///< measures that are rare in this population
};

/// The person that such measures are most likely of, among the people of `population`: normal
/// distributions of its strata given the measures (conditional mean and variance, e.g. Anderson
/// 2003, An Introduction to Multivariate Statistical Analysis, 2.5), strata weighed by how likely
/// they have such measures. Dimensions that the population only keeps in proportion (Evidence
/// kScaled) get a scatter of their own, kProportionScatter, as no one has measured it.
///
/// Throws UsageError: no measure, a dimension that the population doesn't have, a value or
/// deviation out of range.
PersonEstimate estimate_person(const Population& population,
                               const std::vector<KnownMeasure>& measures);

/// Of a width or thickness about the template's proportion: that of the breadths at the finger
/// joints about the circumference (Greiner 1991). A choice.
inline constexpr double kProportionScatter = 0.05;

/// What makes a hand of it: all but the middle finger's proximal length, which the others leave.
std::vector<hand::SizedDimension> sizes_of(const PersonEstimate& estimate);

}  // namespace palmar::population
