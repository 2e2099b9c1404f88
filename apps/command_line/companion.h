// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli.h"

namespace palmar::cli {

// Programs beside palmar that hold the commands which most people don't need every day. They are
// called through palmar all the same; apart, palmar itself is built in half the time.
inline constexpr const char* kHandsProgram = "palmar-hands";        ///< from people to hands
inline constexpr const char* kRedesignProgram = "palmar-redesign";  ///< better shapes, validation
inline constexpr const char* kServeProgram = "palmar-serve";        ///< the workbench

/// Adds the command `name` that `program` holds. When it is met on the command line, that program
/// takes over this process, with all arguments, --help too. Throws ProgramMissing, which says how
/// to get it, if it isn't there.
void add_elsewhere(CLI::App& parent, Context& context, const char* program, const std::string& name,
                   const std::string& description);

}  // namespace palmar::cli
