// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace palmar::cli {

/// Gives every command `--xml`, which describes it for 3D Slicer and others that make a panel of
/// such a description (Slicer Execution Model). After all commands were added.
void add_descriptions(CLI::App& app);

/// One command's arguments and options as an XML document: what kind of value each takes, its
/// default and limits, in the groups of the help page; all but the first groups are "advanced".
/// Long options are spelled with underscores, as the model's schema wants. Left out: options that
/// take several values with commas in them, which a panel would take apart.
std::string module_description(const CLI::App& verb);

/// True if a panel started this program: PALMAR_PROGRESS is "filter".
bool is_module();

/// A panel's command line in Palmar's own words: underscores of options become hyphens; fields that
/// were left empty, or at "(default)", are dropped.
std::vector<std::string> module_words(const std::vector<std::string>& words);

/// Progress on standard output in the model's elements; the first call begins them with what is
/// done then.
void print_panel_progress(double share, const std::string& activity);
/// The last element, if progress was begun.
void finish_panel();

}  // namespace palmar::cli
