// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/population/dimension_table.h"
#include "palmar/records/table_results.h"

namespace palmar::workflow {

// Charts of tables of subjects, each as NAME.svg, NAME.png and NAME.pdf in a folder that is there.
// Throw OutputError.

/// correlation: every group's matrix, correlation_GROUP if there are groups. Pairs with p >= 0.05
/// are grey.
void write_correlation_charts(const std::string& folder, const records::Correlations& results);

/// DIMENSION_on_PREDICTOR: points, line and its bands, all groups in one chart. `groups` are those
/// that the regressions were made of.
void write_scatter_charts(const std::string& folder,
                          const std::vector<population::TableGroup>& groups,
                          const records::Regressions& results);

/// A name of a file from one of people: letters and digits stay.
std::string file_part(const std::string& name);

}  // namespace palmar::workflow
