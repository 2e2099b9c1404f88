// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/cad/model/cad_model.h"
#include "palmar/records/region_json.h"

namespace palmar::cad {

/// What came of a curve: a periodic cubic B-spline.
struct CurveReport {
  int poles = 0;
  double length = 0.0;     ///< mm
  double deviation = 0.0;  ///< mm; farthest of the given points from the curve
  bool is_closed = false;  ///< as a wire
};
struct SurfaceReport {
  bool ends_at_outline = false;  ///< else at a rectangle of its parameters
  double area = 0.0;             ///< mm^2
};

/// A contact region for CAD: the product (may be empty) with the curves as wires and the surfaces
/// as faces, each a body of its own with name and colour.
struct RegionModel {
  CadModel model;
  std::vector<CurveReport> curves;
  std::vector<SurfaceReport> surfaces;
};
/// Curves, and the borders of faces that end at outlines, have the fewest poles that pass their
/// points within 0.1 mm, at most 40 (closed_spline.h). Throws UsageError on a curve of fewer than 4
/// points or a surface without points, NumericalError naming the curve or surface that OpenCASCADE
/// can't make.
RegionModel make_region_model(const CadModel& product,
                              const std::vector<records::NamedCurve>& curves,
                              const std::vector<records::NamedSurface>& surfaces);

}  // namespace palmar::cad
