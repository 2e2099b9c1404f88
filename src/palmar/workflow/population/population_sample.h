// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/population/hand_sample.h"
#include "palmar/population/population.h"
#include "palmar/workflow/note/note.h"

namespace palmar::workflow {

/// Hands of a population.
struct PopulationSampleRequest {
  std::string population;  ///< built-in name, or population file (.toml)
  population::SamplingOptions sampling = {};
  std::string out = {};  ///< file to write, .csv (hand_sample_table()) or .json; "": none
  NoteSink note = {};    ///< cautions of the population
  void check() const;    ///< throws UsageError: field, value, what is allowed
};

struct PopulationSampleOutcome {
  population::Population population;
  std::vector<population::HandSample> hands;
};

/// Draws the hands and writes one row each. Throws UsageError, InputError naming the file,
/// OutputError.
PopulationSampleOutcome sample_population(const PopulationSampleRequest& request);

}  // namespace palmar::workflow
