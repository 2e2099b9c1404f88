// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/tissue/tissue_fit.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <set>

#include "palmar/core/error.h"
#include "palmar/core/text.h"
#include "palmar/hand/tissue.h"

namespace palmar {
namespace {

// Logarithms of the unknowns, in this order.
enum Unknown { kG0, kRho, kLimitDepth, kThickness, kUnknowns };
constexpr std::array<const char*, kUnknowns> kNames = {"G0", "G_lim", "d_lim", "h"};
using Unknowns = std::array<double, kUnknowns>;
using Mask = std::array<bool, kUnknowns>;

constexpr double kLargestRho = 1000.0;
constexpr double kWidestFactor = 3.0;      // of a confidence interval, to either side
constexpr double kLeastStiffening = 1e-3;  // rho - 1 below it: none
constexpr double kSingular = 1e-10;        // eigenvalue of the scaled normal matrix
constexpr double kLeastReading = 0.02;     // share of the largest force; below it relative errors
                                           // say little
constexpr int kGridDepths = 16;

/// Readings, what the specimen answers at their depths, and the residuals of a set of unknowns.
class Model {
 public:
  Model(const std::vector<MeasuredPoint>& points, const SpecimenResponse& response,
        const TissueFitOptions& options)
      : points_(points), is_layer_fitted_(response.thickness.size() > 1) {
    response.check();
    if (is_layer_fitted_) {
      lower_[kThickness] = std::log(response.thickness.front());
      upper_[kThickness] = std::log(response.thickness.back());
    }
    read_points(response, options);
    lower_[kG0] = std::log(kMinShearModulus);
    upper_[kG0] = std::log(kMaxShearModulus);
    lower_[kRho] = 0.0;
    upper_[kRho] = std::log(kLargestRho);
    lower_[kLimitDepth] = std::log(depths_.size() > 1 ? depths_[1] : 0.5 * depths_[0]);
    upper_[kLimitDepth] = std::log(depths_.back());
    if (upper_[kLimitDepth] <= lower_[kLimitDepth]) lower_[kLimitDepth] -= 1.0;
  }

  const std::vector<double>& depths() const { return depths_; }
  double deepest() const { return depths_.back(); }
  bool is_layer_fitted() const { return is_layer_fitted_; }
  double lower(int unknown) const { return lower_[unknown]; }
  double upper(int unknown) const { return upper_[unknown]; }
  std::size_t size() const { return points_.size(); }
  int areas_counted() const { return areas_counted_; }

  /// Force of reading i at unit modulus, and its derivative by log h, over itself.
  PowerCurve::Value unit_force(std::size_t i, double log_h) const {
    return is_layer_fitted_ ? force_[i].at(std::exp(log_h)) : force_[i].at(1.0);
  }
  PowerCurve::Value area(std::size_t i, double log_h) const {
    if (area_.empty()) return {};
    return is_layer_fitted_ ? area_[i].at(std::exp(log_h)) : area_[i].at(1.0);
  }
  bool knows_areas() const { return !area_.empty(); }

  double force(std::size_t i, const Unknowns& x) const {
    const double m = std::min(1.0, points_[i].depth / std::exp(x[kLimitDepth]));
    const double modulus = std::exp(x[kG0]) * (1.0 + (std::exp(x[kRho]) - 1.0) * m);
    return modulus * unit_force(i, x[kThickness]).y;
  }
  double force_scale(std::size_t i) const { return force_scale_[i]; }

  /// Residuals, forces first, and their derivatives by all unknowns.
  void residuals(const Unknowns& x, Eigen::VectorXd& r, Eigen::MatrixXd* jacobian) const {
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

  /// Best G0 and rho at a limit depth and thickness: linear least squares in G0 and G_lim - G0,
  /// both at least 0.
  Unknowns best_linear(double log_limit, double log_h, bool is_constant) const {
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
    base = std::clamp(base, kMinShearModulus, kMaxShearModulus);
    return {std::log(base), std::min(std::log1p(rise / base), upper_[kRho]), log_limit, log_h};
  }

  /// Makes forces and areas count by their own residuals.
  void weigh_by_residuals(const Unknowns& x) {
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

 private:
  void read_points(const SpecimenResponse& response, const TissueFitOptions& options) {
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

  double most_force() const {
    double most = 0.0;
    for (const MeasuredPoint& point : points_) most = std::max(most, point.force);
    return most;
  }

  std::vector<MeasuredPoint> points_;
  bool is_layer_fitted_;
  std::vector<double> depths_;
  std::vector<PowerCurve> force_, area_;          // of thickness, per reading
  std::vector<double> force_scale_, area_scale_;  // per reading
  double force_weight_ = 1.0, area_weight_ = 1.0;
  int areas_counted_ = 0;
  Unknowns lower_{}, upper_{};
};

struct Solved {
  Unknowns x{};
  Mask is_free{};
  LeastSquaresSolution least_squares;
};

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
  LeastSquaresProblem problem;
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
  solved.least_squares = solve_least_squares(problem, from);
  solved.x = whole(solved.least_squares.x);
  return solved;
}

/// The best descent from the three best points of a grid over limit depth and thickness.
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

/// Confidence of the free unknowns' logarithms.
struct Confidence {
  Eigen::MatrixXd covariance;  ///< infinite on the diagonal where the readings show nothing
  Eigen::MatrixXd correlation;
  Eigen::VectorXd eigenvalues;
  double quantile = 0.0;  ///< of Student's t, two-sided
  int degrees_of_freedom = 0;
};

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

StiffeningLaw law_of(const Unknowns& x) {
  const double g0 = std::exp(x[kG0]);
  return {g0, g0 * std::exp(x[kRho]), std::exp(x[kLimitDepth])};
}

Unknowns unknowns_of(const StiffeningLaw& law, double thickness) {
  return {std::log(law.g0), std::log(law.g_limit / law.g0), std::log(law.limit_depth),
          std::log(thickness)};
}

StiffeningLaw scaled(const StiffeningLaw& law, double factor) {
  return {law.g0 * factor, law.g_limit * factor, law.limit_depth};
}

/// A fit in the making.
class Fit {
 public:
  Fit(const std::vector<MeasuredPoint>& points, const SpecimenResponse& response,
      const TissueFitOptions& options)
      : points_(points), options_(options), model_(points, response, options) {
    mask_ = {true, !options.is_constant, !options.is_constant && !options.limit_depth,
             model_.is_layer_fitted()};
    check_counts();
  }

  TissueFit run() {
    solve();
    if (model_.areas_counted() > 0) {
      for (int i = 0; i < 2; ++i) {
        model_.weigh_by_residuals(solved_.x);
        solved_ = descend(model_, solved_.x, solved_.is_free);
      }
    }
    confidence_ = confidence_of(solved_, options_.confidence);
    drop_undetermined();
    report();
    return std::move(fit_);
  }

 private:
  void check_counts() const {
    const auto unknowns = free_unknowns(mask_).size();
    if (points_.size() < unknowns + 1) {
      throw InputError("fit: " + std::to_string(points_.size()) + " readings; at least " +
                       std::to_string(unknowns + 1) + " are required for " +
                       std::to_string(unknowns) + " unknowns and their confidence");
    }
    const std::size_t needed = unknowns - (model_.areas_counted() > 0 ? 1 : 0);
    if (model_.depths().size() < needed) {
      throw InputError("fit: readings at " + std::to_string(model_.depths().size()) +
                       " different depths; at least " + std::to_string(needed) +
                       " are required for " + std::to_string(unknowns) + " unknowns");
    }
  }

  void solve() {
    Unknowns at{};
    at[kLimitDepth] = std::log(options_.limit_depth.value_or(model_.deepest()));
    if (!options_.start) {
      solved_ = search(model_, at, mask_, !mask_[kRho]);
      return;
    }
    Unknowns from = unknowns_of(*options_.start, options_.start_thickness.value_or(1.0));
    if (!mask_[kRho]) from[kRho] = 0.0;
    if (!mask_[kLimitDepth]) from[kLimitDepth] = at[kLimitDepth];
    if (!mask_[kThickness]) from[kThickness] = at[kThickness];
    solved_ = descend(model_, from, mask_);
  }

  /// Half the width of the interval of an unknown's logarithm; of G_lim if that is asked.
  std::optional<double> half_width(int unknown) const {
    const std::vector<int> free = free_unknowns(solved_.is_free);
    Eigen::VectorXd direction = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(free.size()));
    bool is_free = false;
    for (std::size_t j = 0; j < free.size(); ++j) {
      // log G_lim = log G0 + log rho
      const bool counts = free[j] == unknown || (unknown == kRho && free[j] == kG0);
      if (!counts) continue;
      is_free = true;
      direction[static_cast<Eigen::Index>(j)] = 1.0;
    }
    if (!is_free) return std::nullopt;
    const double variance = direction.dot(confidence_.covariance * direction);
    return confidence_.quantile * std::sqrt(std::max(variance, 0.0));
  }

  bool is_at_bound(int unknown) const {
    const double x = solved_.x[unknown];
    const double tiny = 1e-6 * (model_.upper(unknown) - model_.lower(unknown));
    return x <= model_.lower(unknown) + tiny || x >= model_.upper(unknown) - tiny;
  }

  void hold(int unknown, double log_value) {
    solved_.x[unknown] = log_value;
    Mask mask = solved_.is_free;
    mask[unknown] = false;
    solved_ = descend(model_, solved_.x, mask);
    confidence_ = confidence_of(solved_, options_.confidence);
  }

  void drop_undetermined() {
    const double deepest = model_.deepest();
    if (solved_.is_free[kRho] && std::expm1(solved_.x[kRho]) < kLeastStiffening) {
      remark_[kRho] = "the readings show no stiffening: G_lim equals G0";
      remark_[kLimitDepth] = "it has no meaning without stiffening";
      solved_.is_free[kLimitDepth] = false;
      if (mask_[kLimitDepth]) solved_.x[kLimitDepth] = std::log(deepest);
      hold(kRho, 0.0);
      return;
    }
    if (!solved_.is_free[kLimitDepth]) return;
    const double limit = std::exp(solved_.x[kLimitDepth]);
    const double width = half_width(kLimitDepth).value_or(0.0);
    if (limit < 0.98 * deepest && !is_at_bound(kLimitDepth) && width < std::log(kWidestFactor)) {
      return;
    }
    remark_[kLimitDepth] =
        limit >= 0.98 * deepest
            ? "the readings still stiffen at their deepest point, " + significant(deepest, 3) +
                  " mm: held there, and G_lim is the modulus there"
            : "the readings don't show where stiffening ends: held at their deepest point, " +
                  significant(deepest, 3) + " mm";
    hold(kLimitDepth, std::log(deepest));
  }

  void report() {
    const LeastSquaresSolution& numbers = solved_.least_squares;
    fit_.status = numbers.status;
    fit_.iterations = numbers.iterations;
    fit_.degrees_of_freedom = confidence_.degrees_of_freedom;
    for (const int k : free_unknowns(solved_.is_free)) {
      fit_.fitted.emplace_back(k == kRho ? "G_lim/G0" : kNames[k]);
    }
    fit_.correlation = confidence_.correlation;
    fit_.eigenvalues = confidence_.eigenvalues;
    fit_.condition = confidence_.eigenvalues.size() == 0
                         ? 1.0
                         : confidence_.eigenvalues.maxCoeff() /
                               std::max(confidence_.eigenvalues.minCoeff(), 1e-300);
    report_points();
    report_parameters();
    report_range();
    if (fit_.status == LeastSquaresStatus::kIterationLimit ||
        fit_.status == LeastSquaresStatus::kBadStart) {
      fit_.remarks.insert(fit_.remarks.begin(), "The fit did not converge: don't use its numbers.");
    }
    if (fit_.area_ratio && std::abs(*fit_.area_ratio - 1.0) > 0.15) {
      fit_.remarks.push_back("Measured areas are " + significant(*fit_.area_ratio, 3) +
                             " times those of the model. Area doesn't depend on the modulus: "
                             "specimen, indenter, first touch or layer differ from the test.");
    }
  }

  void report_points() {
    double squares = 0.0, total = 0.0, mean = 0.0, weights = 0.0, relative = 0.0, ratio = 0.0,
           area_squares = 0.0, most = 0.0;
    int above = 0, areas = 0;
    for (const MeasuredPoint& point : points_) {
      mean += point.weight * point.force;
      weights += point.weight;
      most = std::max(most, point.force);
    }
    mean /= weights;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const MeasuredPoint& point = points_[i];
      const double force = model_.force(i, solved_.x);
      const double area = model_.area(i, solved_.x[kThickness]).y;
      fit_.points.push_back({point, force, area});
      squares += point.weight * std::pow(force - point.force, 2);
      total += point.weight * std::pow(point.force - mean, 2);
      if (point.force > kLeastReading * most) {
        relative += std::pow(force / point.force - 1.0, 2);
        ++above;
      }
      if (!point.area || *point.area <= 0.0 || area <= 0.0) continue;
      ratio += *point.area / area;
      area_squares += std::pow(area / *point.area - 1.0, 2);
      ++areas;
    }
    fit_.force_rms = std::sqrt(squares / weights);
    fit_.force_rms_relative = above > 0 ? std::sqrt(relative / above) : 0.0;
    fit_.r_squared = total > 0.0 ? 1.0 - squares / total : 0.0;
    if (areas == 0) return;
    fit_.area_ratio = ratio / areas;
    fit_.area_rms_relative = std::sqrt(area_squares / areas);
  }

  void report_parameters() {
    const StiffeningLaw law = law_of(solved_.x);
    const double thickness = std::exp(solved_.x[kThickness]);
    if (mask_[kThickness]) fit_.layer_thickness = thickness;
    const std::array<double, kUnknowns> value = {1000.0 * law.g0, 1000.0 * law.g_limit,
                                                 law.limit_depth, thickness};
    for (int k = 0; k < kUnknowns; ++k) {
      if (k == kThickness && !mask_[k]) continue;
      FittedParameter one;
      one.name = kNames[k];
      one.unit = k == kG0 || k == kRho ? "kPa" : "mm";
      one.value = value[k];
      one.remark = remark_[k];
      const std::optional<double> width =
          solved_.is_free[k] || k == kG0 ? half_width(k) : std::nullopt;
      if (!mask_[k]) {
        one.status = ParameterStatus::kHeld;
        one.remark = k == kRho              ? "equal to G0: one modulus was requested"
                     : options_.is_constant ? "it has no meaning with one modulus"
                                            : "given, not fitted";
      } else if (!solved_.is_free[k]) {
        one.status = ParameterStatus::kNotIdentifiable;
      } else if (width) {
        one.lower = one.value * std::exp(-*width);
        one.upper = one.value * std::exp(*width);
        if (is_at_bound(k)) {
          one.status = ParameterStatus::kNotIdentifiable;
          one.remark = k == kThickness && solved_.x[k] > 0.5 * (model_.lower(k) + model_.upper(k))
                           ? "the readings see no bone: a half-space fits as well"
                           : "it is at the end of the range that is tried";
        } else if (!(*width < std::log(kWidestFactor))) {
          one.status = ParameterStatus::kNotIdentifiable;
          one.remark = "its confidence interval spans more than a factor of three to either side";
        }
      }
      if (one.status == ParameterStatus::kNotIdentifiable) {
        fit_.remarks.push_back(one.name + " is not identifiable: " + one.remark + ".");
      }
      fit_.parameters.push_back(std::move(one));
    }
    if (confidence_.eigenvalues.size() > 0 && confidence_.eigenvalues.minCoeff() < kSingular) {
      fit_.remarks.emplace_back(
          "The normal matrix is singular: some of the parameters act alike on these readings.");
    }
  }

  /// How much the confidence leaves the mean stiffness open, as a logarithm.
  double half_width_of_stiffness() const {
    Eigen::VectorXd r;
    Eigen::MatrixXd all;
    model_.residuals(solved_.x, r, &all);
    const std::vector<int> free = free_unknowns(solved_.is_free);
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(free.size()));
    const auto n = static_cast<Eigen::Index>(points_.size());
    for (Eigen::Index i = 0; i < n; ++i) {
      const double force = all(i, kG0);  // the scaled force itself
      for (std::size_t j = 0; j < free.size(); ++j) {
        if (force > 0.0) mean[static_cast<Eigen::Index>(j)] += all(i, free[j]) / force;
      }
    }
    mean /= static_cast<double>(n);
    return confidence_.quantile * std::sqrt(std::max(mean.dot(confidence_.covariance * mean), 0.0));
  }

  void report_range() {
    TissueStiffness& stiffness = fit_.stiffness;
    stiffness.nominal = law_of(solved_.x);
    stiffness.low = stiffness.nominal;
    stiffness.high = stiffness.nominal;
    std::vector<std::string> names;
    for (const MeasuredPoint& point : points_) {
      if (std::find(names.begin(), names.end(), point.subject) == names.end()) {
        names.push_back(point.subject);
      }
    }
    if (names.size() < 2) {
      constexpr double kMostWidth = 1.0;  // a factor of 2.7; more is no range but ignorance
      const double width = std::min(half_width_of_stiffness(), kMostWidth);
      stiffness.low = scaled(stiffness.nominal, std::exp(-width));
      stiffness.high = scaled(stiffness.nominal, std::exp(width));
    } else {
      for (const std::string& name : names) add_subject(name);
    }
    for (StiffeningLaw* law : {&stiffness.low, &stiffness.high}) {
      law->g0 = std::clamp(law->g0, kMinShearModulus, kMaxShearModulus);
      law->g_limit = std::clamp(law->g_limit, law->g0, kMaxShearModulus);
    }
  }

  void add_subject(const std::string& name) {
    // One subject's readings in the whole table: weights of the others vanish.
    const bool is_constant = std::expm1(solved_.x[kRho]) < kLeastStiffening;
    std::vector<std::size_t> own;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (points_[i].subject == name) own.push_back(i);
    }
    double aa = 0.0, ab = 0.0, bb = 0.0, ay = 0.0, by = 0.0;
    std::vector<double> unit(own.size()), share(own.size());
    for (std::size_t k = 0; k < own.size(); ++k) {
      const std::size_t i = own[k];
      unit[k] = model_.unit_force(i, solved_.x[kThickness]).y;
      share[k] = std::min(1.0, points_[i].depth / std::exp(solved_.x[kLimitDepth]));
      const double a = model_.force_scale(i) * unit[k];
      const double b = a * share[k];
      const double y = model_.force_scale(i) * points_[i].force;
      aa += a * a, ab += a * b, bb += b * b, ay += a * y, by += b * y;
    }
    const double determinant = aa * bb - ab * ab;
    double base = ay / aa;
    double rise = 0.0;
    if (!is_constant && own.size() > 1 && determinant > 1e-12 * aa * bb) {
      base = (bb * ay - ab * by) / determinant;
      rise = (aa * by - ab * ay) / determinant;
      if (base <= 0.0 || rise < 0.0) {  // the shape of all, scaled
        const double rho = std::expm1(solved_.x[kRho]);
        base = (ay + rho * by) / (aa + 2.0 * rho * ab + rho * rho * bb);
        rise = rho * base;
      }
    } else if (!is_constant) {
      const double rho = std::expm1(solved_.x[kRho]);
      base = (ay + rho * by) / (aa + 2.0 * rho * ab + rho * rho * bb);
      rise = rho * base;
    }
    SubjectFit subject;
    subject.subject = name;
    subject.law = {base, base + rise, std::exp(solved_.x[kLimitDepth])};
    subject.points = static_cast<int>(own.size());
    double squares = 0.0;
    for (std::size_t k = 0; k < own.size(); ++k) {
      const double force = (base + rise * share[k]) * unit[k];
      squares += std::pow(force - points_[own[k]].force, 2);
    }
    subject.force_rms = std::sqrt(squares / static_cast<double>(own.size()));
    TissueStiffness& stiffness = fit_.stiffness;
    stiffness.low.g0 = std::min(stiffness.low.g0, subject.law.g0);
    stiffness.low.g_limit = std::min(stiffness.low.g_limit, subject.law.g_limit);
    stiffness.high.g0 = std::max(stiffness.high.g0, subject.law.g0);
    stiffness.high.g_limit = std::max(stiffness.high.g_limit, subject.law.g_limit);
    fit_.subjects.push_back(std::move(subject));
  }

  std::vector<MeasuredPoint> points_;
  TissueFitOptions options_;
  Model model_;
  Mask mask_{};
  Solved solved_;
  Confidence confidence_;
  std::array<std::string, kUnknowns> remark_;
  TissueFit fit_;
};

}  // namespace

void TissueFitOptions::check() const {
  if (limit_depth && !(*limit_depth > 0.0 && *limit_depth <= kMaxTissueLength)) {
    throw UsageError("fit: limit depth is " + significant(*limit_depth, 3) +
                     " mm; more than 0 and at most " + significant(kMaxTissueLength, 3) +
                     " mm is required");
  }
  if (!(confidence > 0.0 && confidence < 1.0)) {
    throw UsageError("fit: confidence is " + significant(confidence, 3) +
                     "; more than 0 and less than 1 is required");
  }
  if (start && !(start->g0 > 0.0 && start->g_limit > 0.0 && start->limit_depth > 0.0)) {
    throw UsageError("fit: the start has a modulus or limit depth of 0 or less");
  }
  if (start_thickness && !(*start_thickness > 0.0)) {
    throw UsageError("fit: the start's thickness is " + significant(*start_thickness, 3) +
                     " mm; more than 0 is required");
  }
}

TissueFit fit_tissue(const std::vector<MeasuredPoint>& points, const SpecimenResponse& response,
                     const TissueFitOptions& options) {
  options.check();
  if (points.empty()) throw InputError("fit: there are no readings");
  double most = 0.0;
  for (const MeasuredPoint& point : points) {
    if (!(point.depth > 0.0 && point.force >= 0.0 && point.weight > 0.0)) {
      throw InputError("fit: line " + std::to_string(point.line) + " has depth " +
                       significant(point.depth, 3) + " mm, force " + significant(point.force, 3) +
                       " N, weight " + significant(point.weight, 3) +
                       "; a depth and weight above 0 are required");
    }
    most = std::max(most, point.force);
  }
  if (!(most > 0.0)) throw InputError("fit: every force is 0 N; some above 0 are required");
  return Fit(points, response, options).run();
}

}  // namespace palmar
