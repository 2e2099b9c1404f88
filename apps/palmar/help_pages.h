// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace palmar::cli {

/// "Example: palmar ..." with lines before it that make the files which it reads.
std::string example_text(const std::string& example);

/// Puts the options of verbs that have many into groups, the ones that matter most first, and gives
/// every group of commands an example of its own. After all commands were added.
void arrange_help(CLI::App& app);

}  // namespace palmar::cli
