// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/population/population_sample.h"

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/records/population/hand_sample_table.h"
#include "palmar/records/population/population_file.h"

namespace palmar::workflow {

void PopulationSampleRequest::check() const {
  if (!out.empty() && !out.ends_with(".csv") && !out.ends_with(".json")) {
    throw UsageError("setting \"out\" " + out + ": a name ending in .csv or .json is required");
  }
  sampling.check();
}

PopulationSampleOutcome sample_population(const PopulationSampleRequest& request) {
  request.check();
  PopulationSampleOutcome outcome;
  outcome.population = records::load_population(request.population);
  outcome.hands = population::sample_hands(outcome.population, request.sampling);
  for (const std::string& caution : outcome.population.cautions) note_to(request.note, caution);
  if (request.out.empty()) return outcome;
  formats::write_file(
      request.out,
      request.out.ends_with(".json")
          ? records::hand_sample_json(outcome.population, request.sampling, outcome.hands)
          : records::format_csv(records::hand_sample_table(outcome.hands)));
  return outcome;
}

}  // namespace palmar::workflow
