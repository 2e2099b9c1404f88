// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "cli.h"
#include "companion.h"

namespace palmar::cli {

void add_commands(CLI::App& app, Context& context) {
  add_assess_command(app, context);
  add_hand_commands(app, context);
  add_product_commands(app, context);
  add_grasp_commands(app, context);
  add_contact_commands(app, context);
  add_effort_commands(app, context);
  add_elsewhere(app, context, kHandsProgram, "mri", "MR images: contents, single steps");
  add_elsewhere(app, context, kHandsProgram, "phantom", "Synthetic persons with known truth");
  add_elsewhere(app, context, kHandsProgram, "photos",
                "A coloured mesh of a hand from photographs: board, lenses, mesh");
  add_population_commands(app, context);
  add_elsewhere(app, context, kRedesignProgram, "redesign",
                "Better shapes for the same hands, and back to CAD");
  add_study_commands(app, context);
  add_elsewhere(app, context, kServeProgram, "serve",
                "The workbench in a browser: move a product in the hand and see what presses; "
                "runs until Ctrl-C");
  add_elsewhere(app, context, kRedesignProgram, "validate",
                "Compare the simulator with closed forms and measurements; exit code 5 on a miss");
  add_doctor_command(app, context);
}

std::string implied_noun(const std::string&) { return {}; }

}  // namespace palmar::cli
