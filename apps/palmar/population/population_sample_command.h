// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli.h"

namespace palmar::cli {

/// `palmar population list`, `show` and `sample`.
void add_population_sample_verbs(CLI::App& population, Context& context);

}  // namespace palmar::cli
