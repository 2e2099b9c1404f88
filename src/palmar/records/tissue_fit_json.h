// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/contact/tissue/tissue_fit.h"

namespace palmar::records {

/// What `palmar contact fit --json` prints: {"status", "parameters": [{"name", "unit", "value",
/// "lower", "upper", "status", "remark"}], "correlation", "eigenvalues", "condition",
/// "force_rms_n", "r_squared", "tissue": {"nominal", "low", "high"}, "subjects", "points",
/// "remarks", "versions"}. `test` says what was pressed with what; `confidence` is that of the
/// intervals.
std::string tissue_fit_json(const contact::TissueFit& fit, const std::string& test,
                            double confidence);

std::string_view name_of(geometry::LeastSquaresStatus status);  ///< "converged", "small_step", ...
std::string_view name_of(
    contact::ParameterStatus status);  ///< "fitted", "held", "not_identifiable"

}  // namespace palmar::records
