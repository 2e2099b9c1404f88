// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace palmar::cli {

/// "Example: palmar ..." with lines before it that make the files which it reads.
std::string example_text(const std::string& example);

/// Titles of the groups of a command's help page that have options, in its order.
std::vector<std::string> option_groups(const CLI::App& app);
/// Its options of one group, in the order of the page.
std::vector<const CLI::Option*> options_in_group(const CLI::App& app, const std::string& title);

/// Puts the options of verbs that have many into groups, the ones that matter most first, and gives
/// every group of commands an example of its own. After all commands were added.
void arrange_help(CLI::App& app);

}  // namespace palmar::cli
