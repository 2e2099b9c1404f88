// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli.h"

namespace palmar::cli {

/// `palmar population describe`, `correlate` and `regress`: tables of subjects.
void add_population_table_verbs(CLI::App& population, Context& context);

}  // namespace palmar::cli
