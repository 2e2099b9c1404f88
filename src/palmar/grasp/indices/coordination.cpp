// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/indices/coordination.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "palmar/core/error.h"
#include "palmar/geometry/degrees.h"

namespace palmar::grasp {
namespace {

constexpr double kLeastVariance = geometry::kDegree * geometry::kDegree;  // rad^2

/// One joint of the construction: angle = mean + spread (first z1 + second z2 + own z_own + what it
/// shares with others), all z standard normal.
struct ConstructedJoint {
  double mean = 0.0, spread = 0.0;   ///< deg
  double first = 0.0, second = 0.0;  ///< loadings on the two synergies
  double own = 0.0;                  ///< share of the rest that no other joint has, 0 to 1
};

/// Middle and spread of a range that holds 90 % of a normal distribution.
ConstructedJoint from_range(double lower, double upper, double first, double second, double own) {
  constexpr double kQuantile95 = 1.645;
  return {0.5 * (lower + upper), (upper - lower) / (2.0 * kQuantile95), first, second, own};
}

ConstructedJoint constructed(hand::Dof dof) {
  // Squares of the two loadings leave 6 to 9 % of the variance for flexion of middle to little
  // finger, more for the index finger and most for the thumb.
  switch (dof) {
    case hand::Dof::kThumbCmcFlexion:
      return {12.0, 12.0, 0.3, 0.1, 1.0};
    case hand::Dof::kThumbCmcAbduction:
      return {42.0, 12.0, -0.3, 0.2, 1.0};
    case hand::Dof::kThumbMpFlexion:
      return {21.0, 12.0, 0.3, 0.2, 1.0};
    case hand::Dof::kThumbIpFlexion:
      return {18.0, 12.0, 0.3, 0.2, 1.0};
    case hand::Dof::kIndexMcpFlexion:
      return from_range(19.0, 71.0, 0.76, -0.52, 1.0);
    case hand::Dof::kMiddleMcpFlexion:
    case hand::Dof::kRingMcpFlexion:
    case hand::Dof::kLittleMcpFlexion:
      return from_range(19.0, 71.0, 0.82, -0.52, 0.5);
    case hand::Dof::kIndexPipFlexion:
      return from_range(23.0, 87.0, 0.72, 0.60, 0.7);
    case hand::Dof::kMiddlePipFlexion:
    case hand::Dof::kRingPipFlexion:
    case hand::Dof::kLittlePipFlexion:
      return from_range(23.0, 87.0, 0.76, 0.60, 0.5);
    case hand::Dof::kIndexDipFlexion:
      return from_range(10.0, 64.0, 0.70, 0.60, 0.5);
    case hand::Dof::kMiddleDipFlexion:
    case hand::Dof::kRingDipFlexion:
    case hand::Dof::kLittleDipFlexion:
      return from_range(10.0, 64.0, 0.74, 0.60, 0.4);
    // Fingers close up as they flex: the index deviates less to the thumb's side, ring and little
    // finger more. Means are departures from the reference posture.
    case hand::Dof::kIndexMcpAbduction:
      return {0.0, 5.0, -0.5, 0.0, 1.0};
    case hand::Dof::kMiddleMcpAbduction:
      return {0.0, 3.0, 0.0, 0.0, 1.0};
    case hand::Dof::kRingMcpAbduction:
      return {0.0, 4.0, 0.4, 0.0, 1.0};
    case hand::Dof::kLittleMcpAbduction:
      return {0.0, 5.0, 0.5, 0.0, 1.0};
    default:
      return {};
  }
}

bool is_finger_abduction(hand::Dof dof) {
  return dof == hand::Dof::kIndexMcpAbduction || dof == hand::Dof::kMiddleMcpAbduction ||
         dof == hand::Dof::kRingMcpAbduction || dof == hand::Dof::kLittleMcpAbduction;
}

/// Joints that share what the synergies leave over: MCP flexion of neighbours, and PIP with DIP of
/// one finger.
int shared_group(hand::Dof dof) {
  switch (dof) {
    case hand::Dof::kMiddleMcpFlexion:
    case hand::Dof::kRingMcpFlexion:
    case hand::Dof::kLittleMcpFlexion:
      return 1;
    case hand::Dof::kIndexPipFlexion:
    case hand::Dof::kIndexDipFlexion:
      return 2;
    case hand::Dof::kMiddlePipFlexion:
    case hand::Dof::kMiddleDipFlexion:
    case hand::Dof::kRingPipFlexion:
    case hand::Dof::kRingDipFlexion:
    case hand::Dof::kLittlePipFlexion:
    case hand::Dof::kLittleDipFlexion:
      return 3;
    default:
      return 0;
  }
}

}  // namespace

DigitAngles digit_angles(const hand::Posture& posture) {
  DigitAngles angles;
  for (int k = 0; k < kDigitDofCount; ++k) angles[k] = posture[digit_dof(k)];
  return angles;
}

CoordinationBasis coordination_basis(const DigitAngles& mean, const DigitMatrix& covariance,
                                     const std::string& source) {
  if (!mean.allFinite() || !covariance.allFinite()) {
    throw UsageError("ease: mean or covariance of the postures is not finite");
  }
  CoordinationBasis basis;
  basis.mean = mean;
  basis.covariance = covariance;
  basis.source = source;
  const Eigen::SelfAdjointEigenSolver<DigitMatrix> solver(covariance);
  double all = 0.0;
  for (int k = 0; k < kDigitDofCount; ++k) {
    const int from = kDigitDofCount - 1 - k;
    basis.variance[k] = std::max(solver.eigenvalues()[from], kLeastVariance);
    basis.component.col(k) = solver.eigenvectors().col(from);
    int largest = 0;  // the sign of a component means nothing; its largest entry shall be positive
    basis.component.col(k).cwiseAbs().maxCoeff(&largest);
    if (basis.component(largest, k) < 0.0) basis.component.col(k) *= -1.0;
    all += basis.variance[k];
  }
  double carried = 0.0;
  while (basis.retained < kDigitDofCount && carried < kRetainedShare * all) {
    carried += basis.variance[basis.retained++];
  }
  basis.retained_share = carried / all;
  return basis;
}

CoordinationBasis coordination_basis(const std::vector<hand::Posture>& postures,
                                     const std::string& source) {
  if (static_cast<int>(postures.size()) < kLeastPostures) {
    throw UsageError("ease: " + source + " has " + std::to_string(postures.size()) +
                     " postures; at least " + std::to_string(kLeastPostures) +
                     " are required for " + std::to_string(kDigitDofCount) + " joint angles");
  }
  const auto count = static_cast<double>(postures.size());
  DigitAngles mean = DigitAngles::Zero();
  for (const hand::Posture& posture : postures) mean += digit_angles(posture) / count;
  DigitMatrix covariance = DigitMatrix::Zero();
  for (const hand::Posture& posture : postures) {
    const DigitAngles away = digit_angles(posture) - mean;
    covariance += away * away.transpose() / (count - 1.0);
  }
  CoordinationBasis basis = coordination_basis(mean, covariance, source);
  basis.postures = static_cast<int>(postures.size());
  return basis;
}

CoordinationBasis built_in_coordination(const hand::Skeleton& skeleton) {
  DigitAngles mean;
  DigitMatrix covariance;
  for (int i = 0; i < kDigitDofCount; ++i) {
    const hand::Dof dof = digit_dof(i);
    const ConstructedJoint a = constructed(dof);
    mean[i] =
        geometry::kDegree * a.mean + (is_finger_abduction(dof) ? skeleton.dof(dof).reference : 0.0);
    for (int k = 0; k < kDigitDofCount; ++k) {
      const ConstructedJoint b = constructed(digit_dof(k));
      double correlation = a.first * b.first + a.second * b.second;
      const double rest = std::sqrt((1.0 - a.first * a.first - a.second * a.second) *
                                    (1.0 - b.first * b.first - b.second * b.second));
      const int group = shared_group(dof);
      if (i == k) {
        correlation = 1.0;
      } else if (group != 0 && group == shared_group(digit_dof(k))) {
        correlation += rest * std::sqrt((1.0 - a.own) * (1.0 - b.own));
      }
      covariance(i, k) = geometry::kDegree * geometry::kDegree * a.spread * b.spread * correlation;
    }
  }
  return coordination_basis(
      mean, covariance,
      "construction, not a measurement: ranges of Bain et al. 2015 and Hume et al. 1990, two "
      "synergies after Santello et al. 1998, spread of thumb and abduction assumed");
}

CoordinationDistance distance_to(const CoordinationBasis& basis, const hand::Posture& posture) {
  CoordinationDistance result;
  const DigitAngles z = basis.component.transpose() * (digit_angles(posture) - basis.mean);
  double inside = 0.0, outside = 0.0;
  for (int k = 0; k < kDigitDofCount; ++k) {
    result.score[k] = z[k] / std::sqrt(basis.variance[k]);
    (k < basis.retained ? inside : outside) +=
        k < basis.retained ? result.score[k] * result.score[k] : z[k] * z[k];
  }
  result.distance = std::sqrt(inside);
  result.outside = std::sqrt(outside / kDigitDofCount);
  // Median of a chi-squared distribution, within 0.5 % from 2 degrees of freedom on (Wilson,
  // Hilferty 1931).
  const double m = basis.retained;
  result.median = std::sqrt(m * std::pow(1.0 - 2.0 / (9.0 * m), 3));
  return result;
}

}  // namespace palmar::grasp
