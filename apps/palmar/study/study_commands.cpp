// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "cli.h"
#include "study/study_arguments.h"
#include "study/study_report_command.h"

namespace palmar::cli {

void add_study_commands(CLI::App& app, Context& context) {
  CLI::App* noun = app.add_subcommand("study", "Many hands holding many products");
  noun->require_subcommand(1);
  noun->fallthrough();
  add_study_run_commands(*noun, context);
  add_study_shard_commands(*noun, context);
  add_study_report_commands(*noun, context);
  add_study_export_command(*noun, context);
  add_study_submit_command(*noun, context);
}

}  // namespace palmar::cli
