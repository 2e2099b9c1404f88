// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/redesign/feature_search.h"

namespace palmar::redesign {

/// A smooth surface through values that scatter: a Gaussian process over [0, 1]^n whose covariance
/// is the sum of one of each variable alone and one of all together (squared exponentials, a
/// constant besides), with noise. Length and share of the noise are those of a small grid with the
/// largest likelihood.
///
/// Source: Rasmussen, Williams 2006, "Gaussian Processes for Machine Learning", 2.2 and 5.4;
/// additive covariances: Duvenaud et al. 2011.
class GoalSurface {
 public:
  /// A column per point; at least one. `roughness`: of each value, how many times the variance of
  /// the noise it has. Throws UsageError if the counts differ.
  GoalSurface(const Eigen::MatrixXd& points, const Eigen::VectorXd& values,
              const Eigen::VectorXd& roughness);
  struct Estimate {
    double mean = 0.0, deviation = 0.0;  ///< of the smooth part, in the values' unit
  };
  Estimate at(const Eigen::VectorXd& point) const;

 private:
  double covariance(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const;

  Eigen::MatrixXd points_;
  Eigen::MatrixXd lower_;  // Cholesky factor of the points' covariance with noise
  Eigen::VectorXd weights_;
  double mean_ = 0.0, scale_ = 1.0, length_ = 0.5;
};

/// As search_features(), by a surface: the start and points spread evenly over the range (a third
/// of the budget, at least two per variable), then always where the surface, less its deviation,
/// is best, and towards the end where it is best itself. Points that `measure` says are beyond a
/// constraint aren't made. The best is the feasible candidate where the surface is best: not the
/// one that was lucky. Deterministic. Source: Jones, Schonlau, Welch 1998; Srinivas et al. 2010.
SearchResult search_by_surface(const SearchProblem& problem, int evaluations,
                               const Progress& progress);

}  // namespace palmar::redesign
