// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "palmar/statistics/summary.h"

namespace palmar::statistics {

/// One number of a regression: the intercept, or what y gains per unit of a predictor.
struct Coefficient {
  double estimate = 0.0;
  double standard_error = 0.0;
  double t = 0.0;        ///< estimate / standard_error
  double p_value = 1.0;  ///< two-sided, of "it is 0"
};

enum class FitStatus {
  kFitted,
  kExact,     ///< y is a linear function of x: standard errors, t and F are 0, p values 0
  kConstantY  ///< y doesn't vary: slopes, R2 and F 0, p values of slopes and F 1
};

/// y = intercept + sum_k slope_k x_k + residual, by least squares.
///
///     R2 = 1 - SS_res / SS_tot,   adjusted R2 = 1 - (1 - R2)(n - 1) / df,
///     residual_sd = sqrt(SS_res / df),   df = n - 1 - k,
///     F = (R2 / k) / ((1 - R2) / df),
///
/// the same figures as R's summary(lm(y ~ x)). Source: Draper & Smith 1998, sections 1.4, 4.1.
struct LinearFit {
  FitStatus status = FitStatus::kFitted;
  int n = 0;
  int df = 0;  ///< of the residuals
  Coefficient intercept;
  std::vector<Coefficient> slopes;  ///< one per predictor
  double r2 = 0.0;
  double adjusted_r2 = 0.0;
  double residual_sd = 0.0;  ///< in the unit of y
  double f = 0.0;
  double f_p_value = 1.0;            ///< of "no predictor matters"
  Eigen::VectorXd predictor_mean;    ///< k
  Eigen::MatrixXd slope_covariance;  ///< k x k, divided by residual_sd^2
};

/// One predictor. Throws UsageError if x and y differ in length, there are fewer than 3 pairs, a
/// value is not finite or x doesn't vary.
LinearFit fit_line(std::span<const double> x, std::span<const double> y);

/// `predictors` n x k. Throws UsageError also if n < k + 2 or a predictor is a linear function of
/// others (named by its column, from 1, or by `names`).
LinearFit fit_linear(const Eigen::MatrixXd& predictors, std::span<const double> y,
                     const std::vector<std::string>& names = {});

/// The fitted line at one place, and the interval round it.
struct Band {
  double value = 0.0;
  double low = 0.0;
  double high = 0.0;
};

/// For the mean of y at x:  value -/+ t(df) residual_sd sqrt(1/n + (x - mean)' C (x - mean)),
/// C = slope_covariance. Throws UsageError if x has not one number per predictor.
Band confidence_band(const LinearFit& fit, double x, double level = 0.95);
Band confidence_band(const LinearFit& fit, const Eigen::VectorXd& x, double level = 0.95);

/// For one new y at x: the same with 1 + 1/n under the root.
Band prediction_band(const LinearFit& fit, double x, double level = 0.95);
Band prediction_band(const LinearFit& fit, const Eigen::VectorXd& x, double level = 0.95);

}  // namespace palmar::statistics
