// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::imaging {

/// A smooth function on the unit cube: uniform cubic B-splines on n x n x n patches.
class SmoothField {
 public:
  /// 0 everywhere.
  explicit SmoothField(int patches);

  /// The function along a line or in a plane of the cube: faster where many places share them.
  struct Line {
    int patches = 1;
    std::vector<double> control;
    double at(double u) const;
  };
  struct Plane {
    int patches = 1;
    std::vector<double> control;  ///< u runs fastest
    Line line(double v) const;
  };
  Plane plane(double w) const;

 private:
  friend class SmoothFieldFit;
  int patches_;
  std::vector<double> control_;  ///< (n + 3)^3, u runs fastest
};

/// Fits SmoothField to values at given places, all along the same places.
///
/// Control point phi_c = sum w^2 phi / sum w^2 over the places that it reaches, where phi = w z /
/// sum over the place's 64 control points of w^2: the local least squares of Lee, Wolberg, Shin
/// 1997, "Scattered data interpolation with multilevel B-splines", eq. (5).
class SmoothFieldFit {
 public:
  /// `places` in [0, 1]^3.
  SmoothFieldFit(const SmoothField& field, const std::vector<Vec3>& places);
  /// Adds the fit of `values` (one per place) to the field, and returns it at the places.
  std::vector<double> add_to(SmoothField& field, const std::vector<double>& values) const;

 private:
  struct Place {
    std::array<int, 3> patch;
    std::array<std::array<double, 4>, 3> weight;
    double square = 0.0;  ///< sum of the squared weights
  };
  int points_;  ///< per edge
  std::vector<Place> places_;
};

}  // namespace palmar::imaging
