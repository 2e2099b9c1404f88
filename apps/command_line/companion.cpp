// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "companion.h"

#include <unistd.h>

#include <filesystem>

#include "palmar/core/program_folder.h"
#include "palmar/formats/process/program_missing.h"

namespace palmar::cli {
namespace {

[[noreturn]] void take_over(const char* program, char** arguments, const std::string& command) {
  const std::filesystem::path beside = program_folder() / program;
  execv(beside.c_str(), arguments);
  const std::string part = std::string(program).substr(std::string("palmar-").size());
  throw formats::ProgramMissing(
      "`" + command + "` needs the program " + program + ", which isn't beside this one (" +
      beside.string() + "): `./demo --also " + part +
      "` in Palmar's source folder builds it, and the package palmar has it");
}

}  // namespace

void add_elsewhere(CLI::App& parent, Context& context, const char* program, const std::string& name,
                   const std::string& description) {
  CLI::App* command = parent.add_subcommand(name, description);
  // Before its own options are looked at: they are the other program's.
  command->preparse_callback([&context, program, command](std::size_t) {
    take_over(program, context.arguments, full_name(*command));
  });
}

}  // namespace palmar::cli
