// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/population/dimension_table.h"
#include "palmar/population/population.h"

namespace palmar::population {

/// What a table of subjects says about the people it was taken from, one stratum per group: driving
/// dimensions with mean, standard deviation and correlation over the subjects that have all of
/// them; every other dimension that Palmar knows by a regression on the driving ones: on all of
/// them if each helps (p < 0.05 beside the others), else on the one that explains most. Residual
/// deviations carry the variation that the regressions leave. Shares are those of the subjects, the
/// age is their mean. A palm length that reaches further than ours (palm_ruler.h) is brought into
/// the template's proportion at each group's mean hand. This, small groups and unknown grip
/// strength become cautions.
///
/// `driving` names columns that are known dimensions. Throws UsageError if one is none; InputError
/// naming file, line and column: constant, singular covariance, too few subjects.
Population population_of_table(const std::vector<TableGroup>& as_measured,
                               const std::vector<std::string>& driving, const std::string& name,
                               const std::string& title);

}  // namespace palmar::population
