// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/report/study/study_page.h"

namespace palmar {

// Parts of study_page(), as HTML. Numbers stand shortened for reading and in full in data-value.

std::string summary_section(const StudyPage& page);
/// Tables of one condition: comparison, regions, who is left out, sizes, size dependence.
std::string condition_tables(const StudyPage& page, const ConditionAnalysis& one);
/// Mean and SD of every quantity and product, indices included.
std::string quantity_table(const StudyPage& page, const ConditionAnalysis& one);
std::string scene_section(const StudyPage& page);
std::string method_section(const StudyPage& page);
std::string provenance_section(const StudyPage& page);

/// Table cell with the number in full beside what is shown; "–" for nothing.
std::string number_cell(std::optional<double> value, int significant = 3);

}  // namespace palmar
