// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "palmar/core/error.h"

namespace palmar::cli {

/// Fields of a request, and the options that set them: {"grip_force", "--grip-force-n"}.
using OptionNames = std::vector<std::pair<std::string, std::string>>;

/// The library's messages name a field of the request in backquotes, `grip_force`; a user reads the
/// option instead. Names that aren't in the list lose their backquotes.
std::string with_option_names(const std::string& message, const OptionNames& names);

/// Calls `run`; errors that it throws on purpose name options instead of fields.
template <typename Run>
auto naming_options(const OptionNames& names, const Run& run) {
  try {
    return run();
  } catch (const UsageError& error) {
    throw UsageError(with_option_names(error.what(), names));
  } catch (const NumericalError& error) {
    throw NumericalError(with_option_names(error.what(), names));
  }
}

/// Runs a check; in its UsageError fields are called by their options. Whole words are replaced,
/// the first entry that fits each.
void check_as_options(const std::function<void()>& check, const OptionNames& names);

}  // namespace palmar::cli
