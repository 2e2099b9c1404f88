// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace palmar::cli {

/// A command line in the present words for options: a name that an option had in the release before
/// (docs/using/options.md) becomes the one that it has now, its number in the unit that the new
/// name says. Only where the verb has the new option and no other of the old name. `notes` gets a
/// sentence for each.
std::vector<std::string> with_present_names(const CLI::App& app, std::vector<std::string> words,
                                            std::vector<std::string>& notes);

}  // namespace palmar::cli
