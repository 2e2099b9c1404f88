// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/statistics/linear_fit.h"

#include <Eigen/QR>
#include <cmath>

#include "palmar/core/error.h"
#include "palmar/statistics/distributions.h"

namespace palmar::statistics {
namespace {

// A predictor of which less than this share is its own counts as a function of the others; R's lm.
constexpr double kRankTolerance = 1e-7;
// Residuals below this share of y's spread are rounding.
constexpr double kExactTolerance = 1e-13;

std::string predictor_name(const std::vector<std::string>& names, Eigen::Index k) {
  if (k < static_cast<Eigen::Index>(names.size())) return names[k];
  return "predictor " + std::to_string(k + 1);
}

Coefficient coefficient(double estimate, double standard_error, const LinearFit& fit) {
  Coefficient c{estimate, standard_error, 0.0, 1.0};
  if (fit.status == FitStatus::kFitted) {
    c.t = estimate / standard_error;
    c.p_value = student_two_sided(c.t, fit.df);
  } else if (estimate != 0.0) {
    c.p_value = 0.0;
  }
  return c;
}

void check_input(const Eigen::MatrixXd& predictors, std::span<const double> y,
                 const std::vector<std::string>& names) {
  const Eigen::Index n = predictors.rows();
  const Eigen::Index k = predictors.cols();
  if (n != static_cast<Eigen::Index>(y.size())) {
    throw UsageError("regression: " + std::to_string(n) + " values of x and " +
                     std::to_string(y.size()) + " of y; as many are needed");
  }
  if (k < 1) throw UsageError("regression without a predictor; at least one is needed");
  check_sample(y, "regression, y", static_cast<int>(k) + 2);
  for (Eigen::Index j = 0; j < k; ++j) {
    const std::span<const double> column(predictors.col(j).data(), static_cast<std::size_t>(n));
    check_sample(column, "regression, " + predictor_name(names, j), static_cast<int>(k) + 2);
    if (is_constant(column)) {
      throw UsageError("regression: " + predictor_name(names, j) + " is " +
                       std::to_string(column[0]) + " throughout; values that vary are needed");
    }
  }
}

double mean_of(const Eigen::VectorXd& values) {
  const double first = values.mean();
  return first + (values.array() - first).mean();  // takes away what rounding left
}

Band band(const LinearFit& fit, const Eigen::VectorXd& x, double level, double own) {
  check_level(level);
  if (x.size() != fit.predictor_mean.size()) {
    throw UsageError("band at a point of " + std::to_string(x.size()) + " numbers; the fit has " +
                     std::to_string(fit.predictor_mean.size()) + " predictors");
  }
  const Eigen::VectorXd d = x - fit.predictor_mean;
  Band result;
  result.value = fit.intercept.estimate;
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    result.value += fit.slopes[k].estimate * x[k];
  }
  const double variance = own + 1.0 / fit.n + d.dot(fit.slope_covariance * d);
  const double half =
      student_quantile(0.5 + 0.5 * level, fit.df) * fit.residual_sd * std::sqrt(variance);
  result.low = result.value - half;
  result.high = result.value + half;
  return result;
}

}  // namespace

LinearFit fit_linear(const Eigen::MatrixXd& predictors, std::span<const double> y,
                     const std::vector<std::string>& names) {
  check_input(predictors, y, names);
  const Eigen::Index n = predictors.rows();
  const Eigen::Index k = predictors.cols();
  const Eigen::Map<const Eigen::VectorXd> y_values(y.data(), n);
  const double y_mean = mean_of(y_values);
  const Eigen::VectorXd y_centred = y_values.array() - y_mean;

  // Centred and scaled columns: the intercept drops out and units don't matter to the rank.
  LinearFit fit;
  fit.n = static_cast<int>(n);
  fit.df = static_cast<int>(n - 1 - k);
  fit.predictor_mean.resize(k);
  Eigen::MatrixXd z(n, k);
  Eigen::VectorXd scale(k);
  for (Eigen::Index j = 0; j < k; ++j) {
    fit.predictor_mean[j] = mean_of(predictors.col(j));
    z.col(j) = predictors.col(j).array() - fit.predictor_mean[j];
    scale[j] = z.col(j).norm();
    z.col(j) /= scale[j];
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(z);
  const Eigen::MatrixXd r = qr.matrixQR().topRows(k).triangularView<Eigen::Upper>();
  for (Eigen::Index j = 0; j < k; ++j) {
    if (std::abs(r(j, j)) < kRankTolerance) {
      throw UsageError("regression: " + predictor_name(names, qr.colsPermutation().indices()[j]) +
                       " is a linear function of the other predictors");
    }
  }
  const Eigen::VectorXd scaled_slopes = qr.solve(y_centred);
  const Eigen::VectorXd slopes = scaled_slopes.cwiseQuotient(scale);
  const Eigen::MatrixXd r_inverse =
      r.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(k, k));
  const Eigen::MatrixXd half =
      scale.cwiseInverse().asDiagonal() * (qr.colsPermutation() * r_inverse);
  fit.slope_covariance = half * half.transpose();

  const double total = y_centred.squaredNorm();
  const double residual = (y_centred - z * scaled_slopes).squaredNorm();
  if (is_constant(y)) {
    fit.status = FitStatus::kConstantY;
    fit.intercept = coefficient(y_mean, 0.0, fit);
    fit.slopes.assign(k, Coefficient{});
    return fit;
  }
  const double magnitude = y_values.cwiseAbs().maxCoeff() * std::sqrt(static_cast<double>(n));
  const bool is_exact =
      std::sqrt(residual) <= kExactTolerance * std::max(std::sqrt(total), magnitude);
  if (is_exact) fit.status = FitStatus::kExact;
  fit.r2 = is_exact ? 1.0 : 1.0 - residual / total;
  fit.adjusted_r2 = 1.0 - (1.0 - fit.r2) * static_cast<double>(n - 1) / fit.df;
  fit.residual_sd = is_exact ? 0.0 : std::sqrt(residual / fit.df);
  if (is_exact) {
    fit.f_p_value = 0.0;
  } else {
    const double explained = (z * scaled_slopes).squaredNorm();
    fit.f = (explained / static_cast<double>(k)) / (residual / fit.df);
    fit.f_p_value = fisher_upper(fit.f, static_cast<double>(k), fit.df);
  }
  for (Eigen::Index j = 0; j < k; ++j) {
    fit.slopes.push_back(
        coefficient(slopes[j], fit.residual_sd * std::sqrt(fit.slope_covariance(j, j)), fit));
  }
  const double at_zero = 1.0 / static_cast<double>(n) +
                         fit.predictor_mean.dot(fit.slope_covariance * fit.predictor_mean);
  fit.intercept = coefficient(y_mean - slopes.dot(fit.predictor_mean),
                              fit.residual_sd * std::sqrt(at_zero), fit);
  return fit;
}

LinearFit fit_line(std::span<const double> x, std::span<const double> y) {
  return fit_linear(
      Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())), y, {"x"});
}

Band confidence_band(const LinearFit& fit, const Eigen::VectorXd& x, double level) {
  return band(fit, x, level, 0.0);
}
Band confidence_band(const LinearFit& fit, double x, double level) {
  return confidence_band(fit, Eigen::VectorXd::Constant(1, x), level);
}
Band prediction_band(const LinearFit& fit, const Eigen::VectorXd& x, double level) {
  return band(fit, x, level, 1.0);
}
Band prediction_band(const LinearFit& fit, double x, double level) {
  return prediction_band(fit, Eigen::VectorXd::Constant(1, x), level);
}

}  // namespace palmar::statistics
