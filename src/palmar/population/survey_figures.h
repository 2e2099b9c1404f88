// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <Eigen/Core>

#include "palmar/grasp/joint_strength.h"

namespace palmar::population {

/// Published figures of hands from which the built-in populations are made; mm. Nothing here is raw
/// survey data.

struct Moment {
  double mean = 0.0, sd = 0.0;
};

/// ANSUR II, 2010-2012 (Gordon et al. 2014): hands of 4 082 men and 1 986 women of the US Army,
/// active, reserve and guard. Moments, correlations and the regression of palm length on hand
/// length of the public files.
struct AnsurFigures {
  int n = 0;
  Moment length, circumference, breadth, palm;
  double r_length_circumference = 0.0, r_length_breadth = 0.0, r_circumference_breadth = 0.0;
  double palm_slope = 0.0;     ///< mm of palm length per mm of hand length
  double palm_residual = 0.0;  ///< mm
};
const AnsurFigures& ansur2_figures(grasp::Sex sex);
/// Of length, circumference and breadth in ANSUR II, in this order.
Eigen::Matrix3d ansur_correlation(grasp::Sex sex);

/// Greiner 1991 (NATICK/TR-92/011): 1 003 men and 1 304 women of the US Army, 1988; from a
/// third party's transcription.
struct GreinerFigures {
  Moment length, circumference;
  Moment thumb_distal;
  /// Lengths between the joints' creases: index, middle, ring, little; proximal, middle, distal.
  std::array<std::array<Moment, 3>, 4> link;
  Moment index_pip_breadth, middle_pip_breadth;
};
const GreinerFigures& greiner_figures(grasp::Sex sex);

/// Share of its mean by which a dimension scatters at given hand length (or circumference) if its
/// mean is in proportion to that:  sqrt(sd^2 - (mean / driver.mean * driver.sd)^2) / mean.
double residual_share(const Moment& dimension, const Moment& driver);

/// Where the segments of built-in populations come from, for people who read a result.
inline constexpr const char* kSegmentCaution =
    "Segments are regressed: other people's scatter about the template's proportions (ANSUR II, "
    "Greiner 1991 at second hand, Buryanov & Kotiuk 2010).";

}  // namespace palmar::population
