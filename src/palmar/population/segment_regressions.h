// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/population/population.h"

namespace palmar::population {

/// Means of the people whose segments are predicted, mm.
struct SegmentDrivers {
  grasp::Sex sex = grasp::Sex::kMale;
  double mean_length = 0.0;         ///< hand length
  double mean_circumference = 0.0;  ///< of the hand
};

/// Palm length and the segments' lengths, widths and thicknesses from hand length L and hand
/// circumference C, in this order, each predictor before what it predicts. Surveys measure segments
/// between other points than measure_hand() does, so only their *relative* figures are taken; at
/// the mean hand every dimension has the template's proportion t:
///
///     palm P:     t L0 (1 + e (L - L0) / L0) + residual      e, residual: ANSUR II
///     finger:     t (L - P) + residual                        residual: Greiner 1991
///     thumb:      t L + residual                              Greiner 1991, Buryanov & Kotiuk 2010
///     width:      of the middle finger's proximal segment t C + residual (Greiner 1991), which all
///                 other widths and thicknesses of the fingers share
///
/// The middle finger's proximal segment is what hand length, palm and its other segments leave, so
/// that no hand contradicts itself. Derivation: docs/method/populations.md.
std::vector<DimensionRegression> segment_regressions(const SegmentDrivers& drivers);

/// The template's own dimensions that the regressions are in proportion to, as measure_hand() gives
/// them, rounded to 0.1 mm.
const hand::HandDimensions& template_proportions();

}  // namespace palmar::population
