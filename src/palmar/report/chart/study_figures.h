// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/report/chart/figure.h"
#include "palmar/study/statistics/study_analysis.h"

namespace palmar::report {

/// One figure of a study's report.
struct StudyFigure {
  std::string name;         ///< of its files: "peak_pressure_cells_mpa", "condition2_accommodation"
  std::string description;  ///< what it shows, in a sentence
  int condition = 0;        ///< index into StudyAnalysis::conditions
  Figure figure;
};

/// Of every condition: distributions of the quantities of the whole hand with brackets between
/// products (p of the t-test after Holm; of more than four products only those with the one whose
/// mean is lowest), their dependence on hand length and circumference, shares of hands inside the
/// limits.
std::vector<StudyFigure> study_figures(const study::StudyResults& results,
                                       const study::StudyAnalysis& analysis);

/// Keys of the quantities that are shown first: peak on sensor cells, peak, mean, area, force.
const std::vector<std::string>& main_quantities();

}  // namespace palmar::report
