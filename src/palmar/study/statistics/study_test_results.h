// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/study/statistics/study_results.h"
#include "palmar/study/statistics/study_statistics.h"

namespace palmar::testing {

/// A study of hands 160, 162, ... mm long with the named products, nothing run yet.
inline study::StudyResults study_of(int hands, const std::vector<std::string>& products,
                                    int populations = 1) {
  study::StudyResults results;
  study::StudyPlan& plan = results.plan;
  plan.name = "test";
  for (int p = 0; p < populations; ++p) {
    study::StudyPopulation population;
    population.population.name = "people" + std::to_string(p + 1);
    plan.populations.push_back(population);
  }
  plan.profiles = {population::HandProfile{}};
  plan.settings = {study::StudySetting{}};
  plan.grips = {std::nullopt};
  for (int h = 0; h < hands; ++h) {
    study::StudyHand hand;
    hand.population = h % populations;
    hand.sample.dimensions = {{study::kHandLength, 160.0 + 2.0 * h},
                              {study::kHandCircumference, 190.0 + (h * 7) % 11}};
    plan.hands.push_back(hand);
  }
  for (const std::string& name : products) {
    study::StudyProduct product;
    product.name = product.family = name;
    plan.products.push_back(product);
  }
  return results;
}

/// A grasp that holds, with a peak pressure on sensor cells [MPa].
inline study::StudyRecord held(std::int64_t number, double peak) {
  study::StudyRecord record;
  record.number = number;
  record.outcome = study::StudyOutcome::kHeld;
  record.is_balanced = true;
  record.force = 100.0;
  record.area = 3000.0;
  record.mean_pressure = 0.03;
  record.peak_pressure = 1.2 * peak;
  record.peak_pressure_cells = peak;
  return record;
}

inline study::StudyRecord not_held(std::int64_t number, study::StudyOutcome outcome) {
  study::StudyRecord record;
  record.number = number;
  record.outcome = outcome;
  return record;
}

}  // namespace palmar::testing
