// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/population/population.h"

namespace palmar::population {

/// Populations that come with Palmar, each with its sources and cautions: xie2014; ansur2_men,
/// ansur2_women, ansur2 (both, in the survey's shares); japanese_men, japanese_women, japanese;
/// those of civilian_populations(). docs/method/populations.md says what was measured and what was
/// borrowed.
const std::vector<Population>& built_in_populations();

/// The built-in population of that name. Throws UsageError naming the nearest one.
const Population& population_named(const std::string& name);

}  // namespace palmar::population
