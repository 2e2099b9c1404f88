// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace palmar {

/// The program that runs: $PALMAR_PROGRAM, which the starters of the portable archive set
/// (scripts/archive.sh), as the system then names the loader; else what the system says. Empty if
/// it doesn't.
std::filesystem::path program_file();

/// Where this program's file is, and so the programs that it starts as children; what Palmar needs
/// at run time is in ../share/palmar of it. Empty if the system doesn't say.
std::filesystem::path program_folder();

/// From now on that folder: for a program that isn't Palmar's own but has loaded it, as Python has.
/// Before any task.
void set_program_folder(const std::filesystem::path& folder);

}  // namespace palmar
