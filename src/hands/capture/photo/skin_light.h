// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace palmar::capture {

/// What one photograph shows of a spot of the skin.
struct SkinSample {
  std::size_t photograph = 0;
  Eigen::Vector3f light;  ///< linear red, green, blue; white paper has three equal ones; exposures
                          ///< brought together
};

/// What light did to the skin from photograph to photograph.
struct SkinLight {
  /// Light that it mirrors over light of its own: how much the brightest directions show more than
  /// the darkest ones show less (2 % of the samples each), 0: matt.
  double gloss = 0.0;
  /// Change of its own light from photograph to photograph, deviation over mean: 0 if lamps and
  /// hand stand still.
  double change = 0.0;
  std::size_t spots = 0;  ///< that were compared; few of them show nothing
};

/// Skin mirrors lamps in their own colour, white, and sends back light of its own in its colour
/// (dichromatic reflection): sample i of a spot is
///
///     c_i = m_i c + w_i (1, 1, 1) |c|_1 / 3,
///
/// c the spot's usual colour (medians over its samples), m_i how much of its own light and w_i how
/// much mirrored light there is. What is left of c_i without its grey part shows m_i, its sum then
/// w_i. Noise spreads w_i evenly to both sides, mirrored light to the bright one. Moved lamps
/// change m_i, and the sum with it, which noise doesn't: the root of their covariance is taken.
/// Spots of fewer than five samples or of nearly no colour are left out. Source: Shafer 1985,
/// "Using color to separate reflection components".
SkinLight judge_skin_light(const std::vector<std::vector<SkinSample>>& spots);

}  // namespace palmar::capture
