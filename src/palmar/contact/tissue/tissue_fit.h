// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "palmar/contact/press/specimen_response.h"
#include "palmar/geometry/least_squares.h"
#include "palmar/hand/hand.h"

namespace palmar::contact {

/// One reading of an indentation test.
struct MeasuredPoint {
  std::string subject;         ///< curves of one subject belong together
  double depth = 0.0;          ///< mm from first touch
  double force = 0.0;          ///< N
  std::optional<double> area;  ///< contact area, mm^2
  double weight = 1.0;         ///< of its squared residual; 1 / variance if that is known
  int line = 0;                ///< of the file it came from
};

struct TissueFitOptions {
  bool is_constant = false;           ///< one modulus, G_lim = G0
  std::optional<double> limit_depth;  ///< d_lim, mm; none: fitted
  /// Residuals relative to the reading instead of in N: every depth counts alike.
  bool is_relative = false;
  double confidence = 0.95;
  std::optional<hand::StiffeningLaw> start;  ///< none: the best of a grid
  std::optional<double> start_thickness;     ///< mm
  void check() const;                        ///< throws UsageError: field, value, allowed range
};

enum class ParameterStatus {
  kFitted,
  kHeld,            ///< given, not fitted
  kNotIdentifiable  ///< the readings can't determine it; see the remark
};

struct FittedParameter {
  std::string name;                    ///< "G0", "G_lim", "d_lim", "h"
  std::string unit;                    ///< "kPa", "mm"
  double value = 0.0;                  ///< in that unit
  std::optional<double> lower, upper;  ///< confidence interval
  ParameterStatus status = ParameterStatus::kFitted;
  std::string remark;
};

struct FittedPoint {
  MeasuredPoint measured;
  double force = 0.0;  ///< of the model, N
  double area = 0.0;   ///< of the model, mm^2
};

/// One subject alone, with d_lim and h of the fit over all.
struct SubjectFit {
  std::string subject;
  hand::StiffeningLaw law;
  int points = 0;
  double force_rms = 0.0;  ///< N
};

struct TissueFit {
  hand::TissueStiffness stiffness;        ///< nominal: all readings; low, high: see fit_tissue()
  std::optional<double> layer_thickness;  ///< fitted, mm
  std::vector<FittedParameter> parameters;
  std::vector<std::string> fitted;   ///< names of the rows of what follows
  Eigen::MatrixXd correlation;       ///< of the logarithms of the fitted parameters
  Eigen::VectorXd eigenvalues;       ///< of the normal matrix scaled to a unit diagonal, ascending
  double condition = 1.0;            ///< their ratio
  double force_rms = 0.0;            ///< root of the mean squared residual, N
  double force_rms_relative = 0.0;   ///< of residual / reading, over readings above 2 % of the most
  double r_squared = 0.0;            ///< 1 - residual / total sum of squares of the forces
  std::optional<double> area_ratio;  ///< measured / model, mean over readings with an area
  std::optional<double> area_rms_relative;
  int degrees_of_freedom = 0;
  geometry::LeastSquaresStatus status = geometry::LeastSquaresStatus::kBadStart;
  int iterations = 0;
  std::vector<FittedPoint> points;
  std::vector<SubjectFit> subjects;  ///< if there are two or more
  std::vector<std::string> remarks;  ///< what a user should know, whole sentences
};

/// Stiffening law (Xie 2014, eq. 3-3), and the thickness h of the layer if `response` has several,
/// from readings of depth, force and area:
///
///     F(d) = G(d) f(d, h),   G(d) = G0 (1 + (rho - 1) min(1, d / d_lim)),   G_lim = rho G0
///
/// f is the force at unit modulus. Least squares (least_squares.h) in log G0, log rho >= 0,
/// log d_lim between the second smallest and the largest depth, and log h; given d_lim and h the
/// rest is linear, so the start is the best of a grid over these two. Areas count only where h is
/// fitted; forces and areas are then weighed by their own residuals. Confidence intervals come from
/// the Jacobian and the residual variance with Student's t, in logarithms (so they are unequal).
///
/// A limit depth that can't be determined from the readings is held at the deepest one and the
/// rest fitted again; readings without stiffening give a constant modulus. A parameter whose
/// interval spans more than a factor of three to either side is named as not identifiable.
///
/// Low and high: with two or more subjects the least and greatest G0 and G_lim of them, each
/// fitted alone with d_lim and h of all; with one, the law times the confidence of its mean
/// stiffness.
///
/// Throws InputError if there are too few readings or depths for the parameters; UsageError on bad
/// options or a response that doesn't reach the readings. Not converging is reported in `status`.
TissueFit fit_tissue(const std::vector<MeasuredPoint>& points, const SpecimenResponse& response,
                     const TissueFitOptions& options = {});

}  // namespace palmar::contact
