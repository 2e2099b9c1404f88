// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "palmar/hand/skeleton.h"

namespace palmar::grasp {

/// The degrees of freedom of the digits: all but the wrist's, in the order of Dof.
inline constexpr int kDigitDofCount = 20;
constexpr hand::Dof digit_dof(int k) {
  return static_cast<hand::Dof>(hand::kDofCount - kDigitDofCount + k);
}

using DigitAngles = Eigen::Matrix<double, kDigitDofCount, 1>;
using DigitMatrix = Eigen::Matrix<double, kDigitDofCount, kDigitDofCount>;
DigitAngles digit_angles(const hand::Posture& posture);  ///< rad

/// How the joints of the digits go together in natural grasps: mean and covariance of their angles
/// and the principal components of that, largest first.
struct CoordinationBasis {
  DigitAngles mean = DigitAngles::Zero();        ///< rad
  DigitMatrix covariance = DigitMatrix::Zero();  ///< rad^2
  DigitMatrix component = DigitMatrix::Zero();   ///< a column each, unit
  DigitAngles variance = DigitAngles::Zero();    ///< along each, rad^2, descending
  int retained = 0;             ///< components that carry retained_share of the variance
  double retained_share = 0.0;  ///< what they really carry
  int postures = 0;             ///< it was taken from; 0: built in
  std::string source;
};

/// Share of the variance that the components of a basis must carry at least.
inline constexpr double kRetainedShare = 0.9;

/// Components of a mean and a covariance. No variance is taken smaller than that of (1 deg)^2, the
/// order of what a goniometer or a data glove resolves.
CoordinationBasis coordination_basis(const DigitAngles& mean, const DigitMatrix& covariance,
                                     const std::string& source);

/// From measured postures, at least kLeastPostures. Throws UsageError for fewer.
CoordinationBasis coordination_basis(const std::vector<hand::Posture>& postures,
                                     const std::string& source);
inline constexpr int kLeastPostures = 30;

/// The built-in basis: **a construction, not a measurement**. No file of hand postures may be
/// shipped here, so it is put together from published figures:
///
/// - mean and spread of finger flexion from the functional range, which holds 90 % of the postures
///   of daily activities: MCP 19-71, PIP 23-87, DIP 10-64 deg (Bain et al. 2015): mean in its
///   middle, standard deviation its width / (2 x 1.645);
/// - thumb: MP 21, IP 18 deg (Hume et al. 1990), spread 12 deg assumed; CMC about what Palmar's own
///   stored grips have (flexion 12, abduction 42 deg, spread 12 deg): assumed;
/// - abduction of the fingers about the reference posture, spread 5 deg: assumed;
/// - coordination: two synergies that carry more than 80 % of the variance, the first all MCP and
///   PIP joints flexing together with the fingers closing up, the second MCP extending while PIP
///   flex (Santello et al. 1998: 84 %); DIP with PIP (Rijkpema and Girard 1991); thumb and index
///   finger the most independent (Ingram et al. 2008). Loadings were chosen to agree with these.
CoordinationBasis built_in_coordination(const hand::Skeleton& skeleton);

/// Where a posture lies to a basis.
struct CoordinationDistance {
  /// Mahalanobis distance within the retained components, sqrt(sum z_k^2 / variance_k), in standard
  /// deviations.
  double distance = 0.0;
  double median = 0.0;   ///< distance within which half of normally distributed postures lie
  double outside = 0.0;  ///< root mean square of what the retained components leave over, rad
  DigitAngles score = DigitAngles::Zero();  ///< z_k / sqrt(variance_k) for every component
};
CoordinationDistance distance_to(const CoordinationBasis& basis, const hand::Posture& posture);

}  // namespace palmar::grasp
