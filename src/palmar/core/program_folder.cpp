// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/core/program_folder.h"

#include <system_error>

namespace palmar {
namespace {

std::filesystem::path& given_folder() {
  static std::filesystem::path folder;
  return folder;
}

}  // namespace

std::filesystem::path program_folder() {
  if (!given_folder().empty()) return given_folder();
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  return error ? std::filesystem::path() : self.parent_path();
}

void set_program_folder(const std::filesystem::path& folder) { given_folder() = folder; }

}  // namespace palmar
