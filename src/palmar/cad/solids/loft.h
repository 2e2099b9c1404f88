// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "palmar/cad/model/named_solid.h"

namespace palmar::cad {

/// Rises from 0 at t = 0 to 1 at t = 1 with no slope and no curvature at both; 0 before, 1 behind.
double smoother_step(double t);

/// A curve through points of given abscissa, ascending, with no slope at any of them: what is
/// defined by its highest and lowest points. Constant before the first and behind the last.
class Undulation {
 public:
  struct Point {
    double at, value;
  };
  explicit Undulation(std::vector<Point> points) : points_(std::move(points)) {}
  double operator()(double at) const;

 private:
  std::vector<Point> points_;
};

/// Point of a superellipse |x / a|^p + |y / b|^p = 1: p = 2 is an ellipse, larger is squarer.
/// `turn` goes round once from 0 to 1, counter-clockwise from +x; an ellipse's points are spaced by
/// its eccentric anomaly.
SectionPoint superellipse(double a, double b, double p, double turn);

/// Part of a loft's side that becomes one face, or one of several around it.
struct LoftBand {
  double begin = 0.0, end = 0.0;  ///< z, mm
  std::vector<double> splits;  ///< turns in [0, 1) where the faces begin, ascending; {}: one face
  std::vector<std::string> names;  ///< one per face
};

/// A smooth solid along z. `section(z, turn)` is the side's point in the plane of z; it must go
/// round once, counter-clockwise, and be smooth in both. Both ends are flat and perpendicular to z,
/// and their edges are rounded with `end_fillet` as a rolling ball would: below the tightest radius
/// of the sections there.
///
/// The side is one bicubic B-spline surface through `columns` x rows points, cut into the faces of
/// `bands` from bottom to top; bands don't reach into the roundings, which become "bottom fillet"
/// and "top fillet". The flat ends are "bottom" and "top".
struct LoftOptions {
  double bottom = 0.0, top = 0.0;  ///< z, mm
  double end_fillet = 0.0;         ///< mm
  /// Over which the roundings turn, up to the flat ends: a quarter of a turn meets these without an
  /// edge, less at an angle. The height of a rounding is end_fillet sin(end_angle).
  double end_angle = 0.5 * std::numbers::pi;
  /// Whether roundings are parted as the bands beside them ("bottom fillet, palm") and have two
  /// more rows beside them, without which the side bulges there by a hundredth of their radius.
  bool splits_fillets = false;
  int columns = 40;
  double row_distance = 5.0;  ///< mm, about
  std::vector<LoftBand> bands;
};
NamedSolid make_loft(const std::function<SectionPoint(double z, double turn)>& section,
                     const LoftOptions& options);

}  // namespace palmar::cad
