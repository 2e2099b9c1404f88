// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "cli.h"
#include "redesign_arguments.h"

namespace palmar::cli {

void add_redesign_commands(CLI::App& app, Context& context) {
  CLI::App* noun =
      app.add_subcommand("redesign", "Better shapes for the same hands, and back to CAD");
  noun->require_subcommand(1);
  noun->fallthrough();
  add_redesign_feature_commands(*noun, context);
  add_redesign_press_command(*noun, context);
  add_redesign_region_command(*noun, context);
  add_redesign_shape_command(*noun, context);
}

}  // namespace palmar::cli
