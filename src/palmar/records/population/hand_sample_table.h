// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/population/hand_sample.h"
#include "palmar/records/csv.h"

namespace palmar::records {

/// One row per hand: subject (its label), stratum, sex ("female", "male", empty), age_years,
/// grip_strength_n (empty: not known), then every dimension, "hand_length_mm", to 0.001 mm. A table
/// of subjects like any other: `palmar population describe` reads it. A dimension that a stratum
/// doesn't have is an empty cell.
CsvTable hand_sample_table(const std::vector<population::HandSample>& hands);

/// The same as JSON with the population, its cautions and how the hands were drawn.
std::string hand_sample_json(const population::Population& population,
                             const population::SamplingOptions& options,
                             const std::vector<population::HandSample>& hands);

/// What a population is: strata, dimensions with mean, deviation, evidence and source, cautions.
std::string population_json(const population::Population& population);

}  // namespace palmar::records
