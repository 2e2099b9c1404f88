// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace palmar::hand {

/// Which muscles hold a digit against given moments: with activations a (share of strength),
///
///     min  sum a_i^n      so that   B a + c = m,   0 <= a <= 1,
///
/// B(k, i) [N mm] the moment of muscle i at full strength about axis k, m [N mm] the moments that
/// muscles must give, c_k the moment of the joint's stop, free in the direction in which a joint at
/// the end of its range is held back. Of muscles of one specific tension, sum a^n is sum (F /
/// PCSA)^n (Crowninshield & Brand 1981, J Biomech 14:793-801).
struct MuscleProblem {
  Eigen::MatrixXd moment_at_strength;  ///< B, axes x muscles, N mm
  Eigen::VectorXd required;            ///< m, N mm
  /// Per axis: +1 the joint's stop can push the angle up, -1 down, 2 both ways, 0 not there.
  Eigen::VectorXi stop;
  int exponent = 3;  ///< n, 2 or 3
  /// Per axis: price of what is missing there, relative to that of the others; empty: all alike.
  Eigen::VectorXd price = {};
};

enum class MuscleStatus {
  kBalanced,
  kOverloaded,   ///< no activations up to 1 can give these moments; `missing` says which
  kNotConverged  ///< the residual stayed above 1e-6
};

struct MuscleSolution {
  MuscleStatus status = MuscleStatus::kNotConverged;
  Eigen::VectorXd activation;  ///< a
  Eigen::VectorXd stop;        ///< c, N mm
  /// What B a + c lacks of m, N mm, least in sum over the axes, each over what all muscles together
  /// could give there; 0 unless overloaded.
  Eigen::VectorXd missing;
  int iterations = 0;
  /// Recomputed largest violation of the optimality conditions: of equilibrium over the largest
  /// moment, of stationarity over the largest gradient.
  double kkt_residual = 0.0;
};

/// Primal-dual interior point method with Mehrotra's predictor and corrector (Nocedal & Wright
/// 2006, section 16.6), on the problem with added missing moments at a price above any muscle's:
/// these are 0 wherever the load can be held. Throws UsageError for an exponent other than 2 or 3,
/// sizes that don't agree, or numbers that aren't finite.
MuscleSolution balance_muscles(const MuscleProblem& problem);

/// What may be missing, of the largest moment about any angle of the hand, and still counts as
/// nothing: a grasp at rest is in balance to 1 %, at the edge of what muscles can do (our choice).
inline constexpr double kNegligibleMoment = 0.02;

/// Whether the muscles give the required moments, each but for `negligible` [N mm].
bool is_enough(const MuscleSolution& solution, double negligible);

/// Least share s of their strength with which the muscles can give the required moments,
///
///     B a + c = m,   0 <= a <= s,
///
/// each but for `negligible` [N mm]; to 1 % of the largest activation of least effort. Above 1:
/// they can't; infinite: nor could muscles 64 times as strong. Throws UsageError as
/// balance_muscles().
double least_strength_share(const MuscleProblem& problem, double negligible);

}  // namespace palmar::hand
