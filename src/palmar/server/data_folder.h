// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

namespace palmar::server {

/// Where the user's data of this program go: $XDG_DATA_HOME/palmar, or ~/.local/share/palmar (XDG
/// Base Directory Specification 0.8, which has relative paths ignored). Nothing if neither is
/// known. Nothing is made.
std::optional<std::filesystem::path> user_data_folder();

}  // namespace palmar::server
