// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "palmar/hand/posture.h"

namespace palmar::grasp {

/// One thing that makes a posture unnatural, as a multiple of what is usual:
///
///     r = (sum of factor_i angle_i - value) / spread,   rad.
struct PostureTerm {
  std::array<hand::Dof, 2> dof{};
  std::array<double, 2> factor{};
  double value = 0.0, spread = 1.0;
};

/// How hands like to be near a natural posture: every angle near its own (flexion 0.35, thumb 0.3,
/// abduction 0.2 rad), DIP at 2/3 of PIP (0.2 rad; Rijkpema & Girard 1991), and neighbours' MCP
/// (0.35 rad) and PIP (0.5 rad) off the natural posture alike. The spreads are our choice.
std::vector<PostureTerm> posture_terms(const hand::Posture& natural);

/// r of a term.
double value_of(const PostureTerm& term, const hand::Posture& posture);

/// Sum of the squares of all terms.
double posture_strain(const hand::Posture& natural, const hand::Posture& posture);

/// Abduction of a finger's MCP joint (not the thumb's).
bool is_abduction(hand::Dof dof);

}  // namespace palmar::grasp
