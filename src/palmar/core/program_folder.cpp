// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/core/program_folder.h"

#include <cstdlib>
#include <system_error>

namespace palmar {
namespace {

std::filesystem::path& given_folder() {
  static std::filesystem::path folder;
  return folder;
}

}  // namespace

std::filesystem::path program_file() {
  if (const char* given = std::getenv("PALMAR_PROGRAM"); given != nullptr && *given != '\0') {
    return given;
  }
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  return error ? std::filesystem::path() : self;
}

std::filesystem::path program_folder() {
  return given_folder().empty() ? program_file().parent_path() : given_folder();
}

void set_program_folder(const std::filesystem::path& folder) { given_folder() = folder; }

}  // namespace palmar
