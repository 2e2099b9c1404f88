// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "cli.h"
#include "population/population_sample_command.h"
#include "population/population_table_commands.h"

namespace palmar::cli {

void add_population_commands(CLI::App& app, Context& context) {
  CLI::App* population =
      app.add_subcommand("population", "Built-in populations and tables of subjects");
  population->require_subcommand(1);
  population->fallthrough();
  add_population_table_verbs(*population, context);
  add_population_sample_verbs(*population, context);
  // Last, or its verbs would start with it.
  population->footer("Example: palmar population sample ansur2 --hands 30 --out hands.csv");
}

}  // namespace palmar::cli
