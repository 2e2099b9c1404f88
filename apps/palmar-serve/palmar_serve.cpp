// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "cli.h"

namespace palmar::cli {

void add_commands(CLI::App& app, Context& context) { add_serve_command(app, context); }

std::string implied_noun(const std::string& first_word) {
  return first_word == "serve" ? "" : "serve";
}

}  // namespace palmar::cli
