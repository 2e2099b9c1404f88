// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/records/table_results.h"

namespace palmar::cli {

// Results of tables of subjects as people read them in a terminal.

std::string descriptions_text(const records::Descriptions& descriptions);
/// p values below 0.05 carry a star, below 0.05 after Holm's adjustment two.
std::string correlations_text(const records::Correlations& correlations);
std::string regressions_text(const records::Regressions& regressions);

}  // namespace palmar::cli
