// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace palmar::records {

/// What a report is made for: stands over its first screen. All may be empty.
struct Project {
  std::string name;       ///< "Kitchen knife, second round"
  std::string author;     ///< a person, a studio
  std::string notes;      ///< a sentence or two for readers
  std::string logo;       ///< bytes of the picture
  std::string logo_type;  ///< "image/png", "image/jpeg" or "image/svg+xml"; "": no logo
  bool is_empty() const { return name.empty() && author.empty() && notes.empty() && logo.empty(); }
};

/// Reads a small TOML file:
///
///     name = "Kitchen knife, second round"
///     author = "Studio Example"
///     notes = "Handles of 3 and 10 mm edge radius."
///     logo = "logo.png"     # PNG, JPEG or SVG, beside this file, at most 1 MB
///
/// Throws InputError naming file, line and key; the logo's file if it can't be read, is none of
/// these or is too large.
Project read_project(const std::filesystem::path& file);

}  // namespace palmar::records
