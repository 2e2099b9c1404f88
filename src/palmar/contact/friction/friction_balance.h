// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "palmar/contact/friction/friction_problem.h"

namespace palmar::contact {

/// The balance of load and friction in numbers of order one. Patch i carries limit_i y_i, |y_i| <=
/// 1, in the base of its tangent plane; forces count in units of the sum of all limits, moments
/// about the patches' mean in that times `length`. Motions that no patch feels (the product lifts
/// off a plane) are left out: the columns of `base_of_motions` span the others, k of them.
struct FrictionBalance {
  Vec3 centre = Vec3::Zero();                        ///< mm
  double length = 1.0;                               ///< mm
  double unit_force = 1.0;                           ///< N
  std::vector<Eigen::Matrix<double, 3, 2>> tangent;  ///< base of each tangent plane
  Eigen::MatrixXd jacobian;         ///< 2 m x k: y^T jacobian = generalised friction force
  Eigen::MatrixXd base_of_motions;  ///< 6 x k, orthonormal: translation, rotation times length
  Eigen::VectorXd load;             ///< k
  double load_size = 0.0;           ///< of the whole load, also the part that no patch feels
  Eigen::Matrix<double, 6, 1> unfelt_load = Eigen::Matrix<double, 6, 1>::Zero();

  int patch_count() const { return static_cast<int>(tangent.size()); }
  auto rows(int patch) const { return jacobian.middleRows<2>(2 * Eigen::Index{patch}); }
  /// From 6 generalised coordinates to mm and rad, `scale` mm per unit.
  SmallMotion motion(const Eigen::Matrix<double, 6, 1>& generalised, double scale) const;
};

FrictionBalance friction_balance(const std::vector<RubbingPatch>& patches, const Wrench& load);

/// Load plus friction, over the size of the load (forces, and moments over `length`).
double balance_error(const FrictionBalance& balance, const std::vector<RubbingPatch>& patches,
                     const Wrench& load, const std::vector<Vec3>& force);

}  // namespace palmar::contact
