// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/server/data_folder.h"

#include <cstdlib>

namespace palmar::server {
namespace {

std::optional<std::filesystem::path> absolute_path_in(const char* variable) {
  const char* const value = std::getenv(variable);
  if (value == nullptr) return std::nullopt;
  std::filesystem::path path = value;
  return path.is_absolute() ? std::optional(path) : std::nullopt;
}

}  // namespace

std::optional<std::filesystem::path> user_data_folder() {
  if (const auto data = absolute_path_in("XDG_DATA_HOME")) return *data / "palmar";
  if (const auto home = absolute_path_in("HOME")) return *home / ".local" / "share" / "palmar";
  return std::nullopt;
}

}  // namespace palmar::server
