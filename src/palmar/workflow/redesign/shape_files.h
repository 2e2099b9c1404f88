// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/report/chart/study_figures.h"
#include "palmar/workflow/redesign/redesign_shape.h"

namespace palmar::workflow {

// What a handle shaped anew is written as; parts of redesign_shape().

/// How far what a solid of the shape keeps of a product lies from it, mm; not the ends' roundings.
struct Deviation {
  double largest = 0.0, rms = 0.0;
};
Deviation kept_deviation(const redesign::HandleShape& shape, const geometry::TriangleMesh& solid,
                         const product::Product& product);

/// The shape as files, and as the product that hands hold. Fills in what the outcome has of them.
product::Product write_shape(const RedesignShapeRequest& request, const product::Product& original,
                             RedesignShapeOutcome& outcome, const Progress& progress);

/// History and choices of the search.
void write_search(const RedesignShapeRequest& request, const RedesignShapeOutcome& outcome);
/// The search in the report.
std::vector<report::StudyFigure> search_figures(const SearchStory& story);

void write_shape_pictures(const RedesignShapeRequest& request, const product::Product& original,
                          const product::Product& redesign, const redesign::HandleShape& shape,
                          const Progress& progress);

/// shape.json, without gains.
nlohmann::ordered_json json_of(const RedesignShapeRequest& request,
                               const RedesignShapeOutcome& outcome);

/// What of the original is replaced, in a sentence.
std::string replaced_words(const redesign::HandleShape& shape);

/// That a handle is hollow and what is made isn't, with the walls over the hollow [mm].
std::string hollow_words(const std::string& product, double wall_before, double wall);

}  // namespace palmar::workflow
