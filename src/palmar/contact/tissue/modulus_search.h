// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "palmar/contact/tissue/block_energy.h"

namespace palmar::contact {

/// Search for the moduli of tissue on bone: the fixed point of stiffening_of() in x_b = ln
/// lambda_b. Plain repetition comes nearer by a factor of 3 to 5 a round, because a block's energy
/// depends a little on its neighbours' moduli; Broyden's method (Broyden 1965, Math Comp
/// 19:577-593) learns how, and what it has learnt still holds in the next posture of a motion.
class ModulusSearch {
 public:
  /// Another contact: differences from the last one say nothing.
  void begin() { has_last_ = false; }
  /// What follows on `from`, whose work asks for `to`.
  BlockStiffening next(const BlockStiffening& from, const BlockStiffening& to);

 private:
  using Vector = Eigen::Matrix<double, hand::kRegionCount, 1>;
  using Matrix = Eigen::Matrix<double, hand::kRegionCount, hand::kRegionCount>;

  Matrix gain_ = Matrix::Identity();  ///< step over what is asked for: -(df/dx)^-1, f = g(x) - x
  Vector last_x_ = Vector::Zero(), last_asked_ = Vector::Zero();
  bool has_last_ = false;
};

}  // namespace palmar::contact
