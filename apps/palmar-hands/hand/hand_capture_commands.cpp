// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "cli.h"
#include "hand/hand_from_mri_command.h"
#include "hand/hand_from_photos_command.h"
#include "hand/hand_from_scan_command.h"
#include "hand/hand_quick_command.h"

namespace palmar::cli {

void add_hand_capture_commands(CLI::App& app, Context& context) {
  CLI::App* hand = app.add_subcommand("hand", "Make, look at, pose and export hands");
  hand->require_subcommand(1);
  hand->fallthrough();
  add_from_mri(*hand, context);
  add_from_scan(*hand, context);
  add_from_photos(*hand, context);
  add_hand_quick(*hand, context);
}

}  // namespace palmar::cli
