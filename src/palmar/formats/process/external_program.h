// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace palmar::formats {

/// Where a program is found on PATH; nothing if it isn't.
std::optional<std::filesystem::path> find_program(const std::string& name);

/// Runs a program in `folder`, with what it prints in the file `log` there, and waits for it.
/// Returns its exit code; 128 + n if signal n ended it. No shell is involved. Throws OutputError if
/// it can't be started.
int run_program(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                const std::filesystem::path& folder, const std::string& log);

/// Starts a program that goes on by itself, without terminal, input and output. Returns false if it
/// can't be started; whether it does what it should isn't known.
bool start_detached(const std::filesystem::path& program,
                    const std::vector<std::string>& arguments);

}  // namespace palmar::formats
