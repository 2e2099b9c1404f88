// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/hand/hand.h"

namespace palmar::hand {

/// Skin vertices that speak for their neighbourhood.
struct SkinSample {
  std::vector<int> vertex;   ///< ascending
  std::vector<double> area;  ///< skin that each stands for, mm^2; sums to the whole skin
  std::vector<int> entry;    ///< per skin vertex, which of them stands for it
};

/// Vertices of the reference posture no two of which (of one region and segment) stand nearer than
/// `spacing` [mm]: the first of every neighbourhood in vertex order, so the choice is always the
/// same. All vertices for spacing 0.
SkinSample sample_skin(const Hand& hand, double spacing);

}  // namespace palmar::hand
