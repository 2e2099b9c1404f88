// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/hand/hand.h"
#include "palmar/hand/hand_dimension.h"

namespace palmar {

/// A driven dimension and what the instance's skin measures.
struct MetDimension {
  HandDimension dimension;
  double asked = 0.0;     ///< mm
  double measured = 0.0;  ///< mm, by measure_hand()
};

/// A hand of given size made from another one.
struct HandInstance {
  Hand hand;
  std::vector<MetDimension> driven;  ///< in the order of `targets`
  double largest_miss = 0.0;         ///< of the driven dimensions, mm
};

/// The hand `base` scaled segment by segment (Xie 2014, 5.4) so that the dimensions in `targets`
/// are met within 0.1 mm as measure_hand() measures them. What is not driven follows: lengths the
/// hand length, widths and thicknesses the circumference, each in the base's proportions. Scale
/// factors change smoothly across creases; joints, bones, limit postures of the thumb, bulges and
/// skinning move along; triangles, segments and regions stay, so fields of different instances
/// compare vertex by vertex. Tissue stays as it is. The skin stays closed and doesn't cross itself.
///
/// Throws UsageError: a dimension twice, a value outside half to twice the base's, dimensions that
/// contradict each other (fingers longer than the hand), all named with value and what is allowed;
/// NumericalError if the dimensions can't be met within 0.1 mm.
HandInstance make_hand_instance(const Hand& base, const std::vector<SizedDimension>& targets);

}  // namespace palmar
