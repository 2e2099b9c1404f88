// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/tissue/tissue_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "palmar/contact/tissue/tissue_fit_model.h"
#include "palmar/core/error.h"
#include "palmar/core/text.h"
#include "palmar/hand/tissue.h"

namespace palmar::contact {
namespace tissue_fit {
namespace {

constexpr double kWidestFactor = 3.0;  // of a confidence interval, to either side

hand::StiffeningLaw law_of(const Unknowns& x) {
  const double g0 = std::exp(x[kG0]);
  return {g0, g0 * std::exp(x[kRho]), std::exp(x[kLimitDepth])};
}

Unknowns unknowns_of(const hand::StiffeningLaw& law, double thickness) {
  return {std::log(law.g0), std::log(law.g_limit / law.g0), std::log(law.limit_depth),
          std::log(thickness)};
}

hand::StiffeningLaw scaled(const hand::StiffeningLaw& law, double factor) {
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
    const geometry::LeastSquaresSolution& numbers = solved_.least_squares;
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
    if (fit_.status == geometry::LeastSquaresStatus::kIterationLimit ||
        fit_.status == geometry::LeastSquaresStatus::kBadStart) {
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
    const hand::StiffeningLaw law = law_of(solved_.x);
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
    hand::TissueStiffness& stiffness = fit_.stiffness;
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
    for (hand::StiffeningLaw* law : {&stiffness.low, &stiffness.high}) {
      law->g0 = std::clamp(law->g0, hand::kMinShearModulus, hand::kMaxShearModulus);
      law->g_limit = std::clamp(law->g_limit, law->g0, hand::kMaxShearModulus);
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
    hand::TissueStiffness& stiffness = fit_.stiffness;
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
}  // namespace tissue_fit

void TissueFitOptions::check() const {
  if (limit_depth && !(*limit_depth > 0.0 && *limit_depth <= hand::kMaxTissueLength)) {
    throw UsageError("fit: limit depth is " + significant(*limit_depth, 3) +
                     " mm; more than 0 and at most " + significant(hand::kMaxTissueLength, 3) +
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
  return tissue_fit::Fit(points, response, options).run();
}

}  // namespace palmar::contact
