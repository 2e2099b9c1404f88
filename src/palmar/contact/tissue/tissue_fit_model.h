// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "palmar/contact/press/specimen_response.h"
#include "palmar/contact/tissue/tissue_fit.h"
#include "palmar/geometry/least_squares.h"

/// The model behind fit_tissue() (tissue_fit.cpp): residuals of readings, descent and confidence.
namespace palmar::contact::tissue_fit {

/// Logarithms of the unknowns, in this order.
enum Unknown { kG0, kRho, kLimitDepth, kThickness, kUnknowns };
inline constexpr std::array<const char*, kUnknowns> kNames = {"G0", "G_lim", "d_lim", "h"};
using Unknowns = std::array<double, kUnknowns>;
using Mask = std::array<bool, kUnknowns>;

inline constexpr double kLeastStiffening = 1e-3;  // rho - 1 below it: none
inline constexpr double kSingular = 1e-10;        // eigenvalue of the scaled normal matrix
/// Share of the largest force; below it relative errors say little.
inline constexpr double kLeastReading = 0.02;

/// Readings, what the specimen answers at their depths, and the residuals of a set of unknowns.
class Model {
 public:
  Model(const std::vector<MeasuredPoint>& points, const SpecimenResponse& response,
        const TissueFitOptions& options);

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
  void residuals(const Unknowns& x, Eigen::VectorXd& r, Eigen::MatrixXd* jacobian) const;

  /// Best G0 and rho at a limit depth and thickness: linear least squares in G0 and G_lim - G0,
  /// both at least 0.
  Unknowns best_linear(double log_limit, double log_h, bool is_constant) const;

  /// Makes forces and areas count by their own residuals.
  void weigh_by_residuals(const Unknowns& x);

 private:
  void read_points(const SpecimenResponse& response, const TissueFitOptions& options);

  double most_force() const;

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
  geometry::LeastSquaresSolution least_squares;
};

std::vector<int> free_unknowns(const Mask& mask);

Solved descend(const Model& model, const Unknowns& start, const Mask& mask);

/// The best descent from the three best points of a grid over limit depth and thickness.
Solved search(const Model& model, const Unknowns& at, const Mask& mask, bool is_constant);

/// Confidence of the free unknowns' logarithms.
struct Confidence {
  Eigen::MatrixXd covariance;  ///< infinite on the diagonal where the readings show nothing
  Eigen::MatrixXd correlation;
  Eigen::VectorXd eigenvalues;
  double quantile = 0.0;  ///< of Student's t, two-sided
  int degrees_of_freedom = 0;
};

Confidence confidence_of(const Solved& solved, double level);

}  // namespace palmar::contact::tissue_fit
