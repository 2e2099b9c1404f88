// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "cli.h"
#include "mri/mri_commands.h"
#include "phantom/phantom_commands.h"
#include "photos/photos_commands.h"

namespace palmar::cli {

void add_commands(CLI::App& app, Context& context) {
  add_hand_capture_commands(app, context);
  add_mri_commands(app, context);
  add_phantom_commands(app, context);
  add_photos_commands(app, context);
}

std::string implied_noun(const std::string& first_word) {
  return first_word.starts_with("from-") || first_word == "quick" ? "hand" : "";
}

}  // namespace palmar::cli
