// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "cli.h"

namespace palmar::cli {

void add_commands(CLI::App& app, Context& context) {
  add_redesign_commands(app, context);
  add_validate_command(app, context);
}

std::string implied_noun(const std::string&) { return {}; }

}  // namespace palmar::cli
