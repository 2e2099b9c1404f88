// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "palmar/population/population.h"

namespace palmar::population {

/// All dimensions of a stratum together, as the model has them: driving ones, then regressed ones.
struct JointMoments {
  std::vector<hand::HandDimension> dimension;
  Eigen::VectorXd mean;        ///< mm
  Eigen::MatrixXd covariance;  ///< mm^2
};

/// Predictors must be known (fault_of()).
JointMoments joint_moments(const Stratum& stratum);

}  // namespace palmar::population
