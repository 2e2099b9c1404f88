// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/tissue/tissue_fit_model.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <set>

#include "palmar/core/error.h"
#include "palmar/core/text.h"
#include "palmar/hand/tissue.h"

namespace palmar::contact::tissue_fit {
namespace {

constexpr double kLargestRho = 1000.0;
constexpr int kGridDepths = 16;

}  // namespace

Model::Model(const std::vector<MeasuredPoint>& points, const SpecimenResponse& response,
             const TissueFitOptions& options)
    : points_(points), is_layer_fitted_(response.thickness.size() > 1) {
  response.check();
  if (is_layer_fitted_) {
    lower_[kThickness] = std::log(response.thickness.front());
    upper_[kThickness] = std::log(response.thickness.back());
  }
  read_points(response, options);
  lower_[kG0] = std::log(hand::kMinShearModulus);
  upper_[kG0] = std::log(hand::kMaxShearModulus);
  lower_[kRho] = 0.0;
  upper_[kRho] = std::log(kLargestRho);
  lower_[kLimitDepth] = std::log(depths_.size() > 1 ? depths_[1] : 0.5 * depths_[0]);
  upper_[kLimitDepth] = std::log(depths_.back());
  if (upper_[kLimitDepth] <= lower_[kLimitDepth]) lower_[kLimitDepth] -= 1.0;
}

void Model::residuals(const Unknowns& x, Eigen::VectorXd& r, Eigen::MatrixXd* jacobian) const {
  const auto n = static_cast<Eigen::Index>(points_.size());
  r.resize(n + areas_counted_);
  if (jacobian != nullptr) jacobian->setZero(n + areas_counted_, kUnknowns);
  const double g0 = std::exp(x[kG0]);
  const double rho = std::exp(x[kRho]);
  const double limit = std::exp(x[kLimitDepth]);
  Eigen::Index row = n;
  for (Eigen::Index k = 0; k < n; ++k) {
    const MeasuredPoint& point = points_[k];
    const PowerCurve::Value f = unit_force(k, x[kThickness]);
    const double m = std::min(1.0, point.depth / limit);
    const double modulus = g0 * (1.0 + (rho - 1.0) * m);
    const double scale = force_scale_[k] * force_weight_;
    r[k] = scale * (modulus * f.y - point.force);
    if (jacobian != nullptr) {
      (*jacobian)(k, kG0) = scale * modulus * f.y;
      (*jacobian)(k, kRho) = scale * g0 * rho * m * f.y;
      if (m < 1.0) (*jacobian)(k, kLimitDepth) = -scale * g0 * (rho - 1.0) * m * f.y;
      (*jacobian)(k, kThickness) = scale * modulus * f.y * f.slope;
    }
    if (areas_counted_ == 0 || !point.area) continue;
    const PowerCurve::Value a = area(k, x[kThickness]);
    const double area_scale = area_scale_[k] * area_weight_;
    r[row] = area_scale * (a.y - *point.area);
    if (jacobian != nullptr) (*jacobian)(row, kThickness) = area_scale * a.y * a.slope;
    ++row;
  }
}

Unknowns Model::best_linear(double log_limit, double log_h, bool is_constant) const {
  double aa = 0.0, ab = 0.0, bb = 0.0, ay = 0.0, by = 0.0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double a = force_scale_[i] * unit_force(i, log_h).y;
    const double b = a * std::min(1.0, points_[i].depth / std::exp(log_limit));
    const double y = force_scale_[i] * points_[i].force;
    aa += a * a, ab += a * b, bb += b * b, ay += a * y, by += b * y;
  }
  const double determinant = aa * bb - ab * ab;
  double base = ay / aa;
  double rise = 0.0;
  if (!is_constant && determinant > 1e-12 * aa * bb) {
    base = (bb * ay - ab * by) / determinant;
    rise = (aa * by - ab * ay) / determinant;
    if (base <= 0.0) {
      rise = std::max(by / bb, 0.0);
      base = 1e-3 * rise;
    } else if (rise < 0.0) {
      base = ay / aa;
      rise = 0.0;
    }
  }
  base = std::clamp(base, hand::kMinShearModulus, hand::kMaxShearModulus);
  return {std::log(base), std::min(std::log1p(rise / base), upper_[kRho]), log_limit, log_h};
}

void Model::weigh_by_residuals(const Unknowns& x) {
  double force = 0.0;
  double area_sum = 0.0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    force += std::pow(force_scale_[i] * (this->force(i, x) - points_[i].force), 2);
    if (points_[i].area && areas_counted_ > 0) {
      area_sum += std::pow(area_scale_[i] * (area(i, x[kThickness]).y - *points_[i].area), 2);
    }
  }
  constexpr double kBest = 1e-4;  // of the readings; nothing is measured better
  force_weight_ = 1.0 / std::max(std::sqrt(force / static_cast<double>(size())), kBest);
  area_weight_ = 1.0 / std::max(std::sqrt(area_sum / areas_counted_), kBest);
}

void Model::read_points(const SpecimenResponse& response, const TissueFitOptions& options) {
  std::set<double> depths;
  double force_sum = 0.0;
  double area_sum = 0.0;
  int areas = 0;
  for (const MeasuredPoint& point : points_) {
    depths.insert(point.depth);
    force_sum += point.weight * point.force * point.force;
    if (point.area) area_sum += *point.area * *point.area;
    areas += point.area ? 1 : 0;
  }
  depths_.assign(depths.begin(), depths.end());
  constexpr double kSlack = 1e-9;
  if (depths_.front() < response.depth.front() * (1.0 - kSlack) ||
      depths_.back() > response.depth.back() * (1.0 + kSlack)) {
    throw UsageError("fit: readings from " + significant(depths_.front(), 3) + " to " +
                     significant(depths_.back(), 3) +
                     " mm; the specimen's response is known from " +
                     significant(response.depth.front(), 3) + " to " +
                     significant(response.depth.back(), 3) + " mm");
  }
  const double force_rms = std::sqrt(force_sum / static_cast<double>(points_.size()));
  const double area_rms = areas > 0 ? std::sqrt(area_sum / areas) : 1.0;
  const double most = most_force();
  for (const MeasuredPoint& point : points_) {
    const double least = kLeastReading * most;
    force_scale_.push_back(options.is_relative
                               ? std::sqrt(point.weight) / std::max(point.force, least)
                               : std::sqrt(point.weight) / force_rms);
    area_scale_.push_back(1.0 / area_rms);
  }
  areas_counted_ = is_layer_fitted_ ? areas : 0;
  const bool knows_areas = (response.area.array() > 0.0).all();
  if (!knows_areas) areas_counted_ = 0;
  // First along the depths at every thickness, then per reading along the thickness.
  const std::vector<double> unit = {1.0};
  const std::vector<double>& thickness = is_layer_fitted_ ? response.thickness : unit;
  std::vector<PowerCurve> force_of_depth, area_of_depth;
  for (Eigen::Index j = 0; j < static_cast<Eigen::Index>(thickness.size()); ++j) {
    force_of_depth.emplace_back(response.depth, response.force.col(j));
    if (knows_areas) area_of_depth.emplace_back(response.depth, response.area.col(j));
  }
  const auto through = [&](const std::vector<PowerCurve>& curves, double depth) {
    Eigen::VectorXd y(static_cast<Eigen::Index>(curves.size()));
    for (std::size_t j = 0; j < curves.size(); ++j) {
      y[static_cast<Eigen::Index>(j)] = curves[j].at(depth).y;
    }
    return PowerCurve(thickness, y);
  };
  for (const MeasuredPoint& point : points_) {
    force_.push_back(through(force_of_depth, point.depth));
    if (knows_areas) area_.push_back(through(area_of_depth, point.depth));
  }
}

double Model::most_force() const {
  double most = 0.0;
  for (const MeasuredPoint& point : points_) most = std::max(most, point.force);
  return most;
}

std::vector<int> free_unknowns(const Mask& mask) {
  std::vector<int> list;
  for (int k = 0; k < kUnknowns; ++k) {
    if (mask[k]) list.push_back(k);
  }
  return list;
}

Solved descend(const Model& model, const Unknowns& start, const Mask& mask) {
  const std::vector<int> free = free_unknowns(mask);
  const auto n = static_cast<Eigen::Index>(free.size());
  geometry::LeastSquaresProblem problem;
  problem.lower.resize(n);
  problem.upper.resize(n);
  Eigen::VectorXd from(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const int k = free[j];
    problem.lower[j] = model.lower(k);
    problem.upper[j] = model.upper(k);
    from[j] = start[k];
  }
  const auto whole = [&](const Eigen::VectorXd& x) {
    Unknowns all = start;
    for (Eigen::Index j = 0; j < n; ++j) {
      all[free[j]] = x[j];
    }
    return all;
  };
  problem.evaluate = [&](const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* jacobian) {
    Eigen::MatrixXd all;
    model.residuals(whole(x), r, jacobian != nullptr ? &all : nullptr);
    if (jacobian == nullptr) return;
    jacobian->resize(r.size(), n);
    for (Eigen::Index j = 0; j < n; ++j) {
      jacobian->col(j) = all.col(free[j]);
    }
  };
  Solved solved;
  solved.is_free = mask;
  solved.least_squares = geometry::solve_least_squares(problem, from);
  solved.x = whole(solved.least_squares.x);
  return solved;
}

Solved search(const Model& model, const Unknowns& at, const Mask& mask, bool is_constant) {
  std::vector<std::pair<double, Unknowns>> starts;
  Eigen::VectorXd residual;
  const int depths = mask[kLimitDepth] ? kGridDepths : 1;
  const int thicknesses = mask[kThickness] ? kGridDepths : 1;
  const auto step = [&](int unknown, int i) {
    return model.lower(unknown) +
           (i + 0.5) / kGridDepths * (model.upper(unknown) - model.lower(unknown));
  };
  for (int i = 0; i < depths; ++i) {
    for (int j = 0; j < thicknesses; ++j) {
      const double limit = mask[kLimitDepth] ? step(kLimitDepth, i) : at[kLimitDepth];
      const double h = mask[kThickness] ? step(kThickness, j) : at[kThickness];
      const Unknowns x = model.best_linear(limit, h, is_constant);
      model.residuals(x, residual, nullptr);
      starts.emplace_back(residual.squaredNorm(), x);
    }
  }
  std::stable_sort(starts.begin(), starts.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  Solved best;
  for (std::size_t s = 0; s < std::min<std::size_t>(3, starts.size()); ++s) {
    Solved one = descend(model, starts[s].second, mask);
    if (s == 0 || one.least_squares.sum_of_squares < best.least_squares.sum_of_squares) {
      best = std::move(one);
    }
  }
  return best;
}

Confidence confidence_of(const Solved& solved, double level) {
  const Eigen::MatrixXd& jacobian = solved.least_squares.jacobian;
  const Eigen::Index n = jacobian.cols();
  Confidence result;
  result.degrees_of_freedom = static_cast<int>(jacobian.rows() - n);
  const Eigen::VectorXd length = jacobian.colwise().norm().transpose();
  Eigen::MatrixXd scaled = Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const double both = length[i] * length[j];
      if (i != j) scaled(i, j) = both > 0.0 ? jacobian.col(i).dot(jacobian.col(j)) / both : 0.0;
    }
    if (length[i] == 0.0) scaled(i, i) = 0.0;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  result.eigenvalues = eigen.eigenvalues();
  const double variance = result.degrees_of_freedom > 0
                              ? solved.least_squares.sum_of_squares / result.degrees_of_freedom
                              : std::numeric_limits<double>::infinity();
  // Directions that the readings don't see get a variance beyond all bounds, but finite.
  const Eigen::VectorXd inverse = result.eigenvalues.cwiseMax(1e-3 * kSingular).cwiseInverse();
  const Eigen::MatrixXd unscaled =
      eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
  result.covariance.resize(n, n);
  result.correlation.resize(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const double both = std::max(length[i] * length[j], 1e-300);
      result.covariance(i, j) = variance * unscaled(i, j) / both;
      result.correlation(i, j) = unscaled(i, j) / std::sqrt(unscaled(i, i) * unscaled(j, j));
    }
  }
  if (result.degrees_of_freedom > 0) {
    const boost::math::students_t student(result.degrees_of_freedom);
    result.quantile = boost::math::quantile(student, 0.5 + 0.5 * level);
  }
  return result;
}

}  // namespace palmar::contact::tissue_fit
