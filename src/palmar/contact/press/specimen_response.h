// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "palmar/contact/press/press.h"

namespace palmar::contact {

/// What an indentation test gives at a shear modulus of 1 MPa, at given depths and, if it isn't
/// known, for several thicknesses of the layer over bone. Force is proportional to the modulus at a
/// given depth and area doesn't depend on it, so this table is all that a fit needs.
struct SpecimenResponse {
  std::vector<double> depth;      ///< mm, ascending
  std::vector<double> thickness;  ///< mm, ascending; empty: none or a known one
  Eigen::MatrixXd force;          ///< N/MPa; row: depth, column: thickness
  Eigen::MatrixXd area;           ///< mm^2; 0: not known

  void check() const;  ///< throws UsageError: sizes, order, forces that are not positive
};

/// The test `test` (its depths, forces and modulus are ignored) by press(), at the distinct ones of
/// `depths`, or at 32 of a geometric row if there are more. Throws as press() does.
SpecimenResponse specimen_response(const PressOptions& test, const std::vector<double>& depths,
                                   const std::vector<double>& thickness = {},
                                   const PreparedHand* hand = nullptr);

/// Thicknesses that a fit tries for tests as deep as `deepest` mm: 16 in a geometric row from 1.1
/// times that depth to 100 mm.
std::vector<double> thicknesses_to_try(double deepest);

/// A positive function through points of ascending x: cubic Hermite in log x and log y with slopes
/// of the parabola through three neighbours, so that power laws come out exactly.
class PowerCurve {
 public:
  PowerCurve(const std::vector<double>& x, const Eigen::VectorXd& y);
  /// Value and derivative d log y / d log x; x within the points' range.
  struct Value {
    double y = 0.0;
    double slope = 0.0;
  };
  Value at(double x) const;

 private:
  std::vector<double> log_x_, log_y_, slope_;
};

}  // namespace palmar::contact
