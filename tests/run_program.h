// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace palmar::testing {

struct ProgramRun {
  int exit_code = -1;  ///< -1 if it was ended by a signal
  std::string out, err;
};

/// Runs "palmar ARGUMENTS" through the shell (so redirections work) in `folder`.
ProgramRun run_palmar(const std::string& arguments, const std::string& folder = ".");

/// Whether a program stands beside palmar: `./check` builds palmar-hands with --hands alone.
bool has_program(const std::string& name);

/// A fresh folder that is removed, with what is in it, at the end of the test program's run.
std::string temporary_folder();

/// Writes a file in the test's own folder and returns its path.
std::string write_text(const std::string& path, const std::string& text);

/// Whole content of a file, or "" if there is none.
std::string read_text(const std::string& path);

}  // namespace palmar::testing
