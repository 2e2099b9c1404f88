// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/contact/tissue/tissue_fit.h"

namespace palmar::records {

/// Readings of indentation tests from a CSV file.
struct MeasuredCurves {
  std::vector<contact::MeasuredPoint> points;  ///< in the file's order, depth above 0
  std::vector<std::string> ignored;            ///< columns that mean nothing here
  int zero_depths = 0;                         ///< rows at depth 0, left out: they show nothing
};

/// A CSV file as read_csv() takes it apart. Columns:
///
///     depth_mm                     from first touch
///     force_n or force_mn          newton or millinewton
///     area_mm2 or area_cm2         optional, empty where not measured
///     subject                      optional: whose curve
///     weight or force_sd_n, force_sd_mn   optional: of the reading
///
/// Throws InputError naming file, line, column and what is needed: missing, doubled or nameless
/// column, unknown unit, row of another length, no number, depth, force or area below 0, weight or
/// standard deviation not above 0, no reading.
MeasuredCurves read_measured_curves(const std::string& path);

}  // namespace palmar::records
