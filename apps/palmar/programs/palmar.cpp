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
  add_elsewhere(app, context, kCaptureProgram, "mri", "MR images: contents, single steps");
  add_elsewhere(app, context, kCaptureProgram, "phantom", "Synthetic persons with known truth");
  add_elsewhere(app, context, kCaptureProgram, "photos",
                "A coloured mesh of a hand from photographs: board, lenses, mesh");
  add_population_commands(app, context);
  add_elsewhere(app, context, kRedesignProgram, "redesign",
                "Better shapes for the same hands, and back to CAD");
  add_study_commands(app, context);
  add_serve_command(app, context);
  add_elsewhere(app, context, kRedesignProgram, "validate",
                "Compare the simulator with closed forms and measurements; exit code 5 on a miss");
  add_doctor_command(app, context);
}

}  // namespace palmar::cli
