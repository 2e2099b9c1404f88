// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palmar::formats {

/// One table of a TOML file that is being read. What it complains of is an InputError naming file,
/// line, section and key, the value with its unit, and what is allowed.
class TomlSection {
 public:
  /// `name`: as messages have it, "" for the file itself. The table must outlive the section.
  TomlSection(std::string path, std::string name, const toml::table& table);

  /// Refuses keys that are not in the list, naming the nearest one that is.
  void allow(const std::vector<std::string>& keys) const;
  bool has(std::string_view key) const;

  /// Nothing where the key is missing; whole numbers are numbers too. Edges are inclusive.
  std::optional<double> number(std::string_view key, std::string_view unit, double lowest,
                               double highest) const;
  std::optional<std::int64_t> integer(std::string_view key, std::int64_t lowest,
                                      std::int64_t highest) const;
  std::optional<std::string> text(std::string_view key) const;
  std::optional<bool> boolean(std::string_view key) const;
  /// Empty where the key is missing.
  std::vector<std::string> texts(std::string_view key) const;
  std::vector<double> numbers(std::string_view key, std::string_view unit, double lowest,
                              double highest) const;
  std::optional<TomlSection> table(std::string_view key) const;
  /// [[key]]; empty where the key is missing.
  std::vector<TomlSection> tables(std::string_view key) const;

  /// The same for keys that must be there.
  double need_number(std::string_view key, std::string_view unit, double lowest,
                     double highest) const;
  std::string need_text(std::string_view key) const;

  [[noreturn]] void fail(const std::string& why) const;  ///< at the section's first line
  [[noreturn]] void fail(std::string_view key, const std::string& why) const;

  const toml::table& values() const { return *table_; }
  const std::string& path() const { return path_; }

 private:
  const toml::node* find(std::string_view key) const;
  std::string label(std::string_view key) const;  ///< "[[stratum]] share"
  double in_range(const toml::node& node, std::string_view key, std::string_view unit,
                  double lowest, double highest) const;

  std::string path_, name_;
  const toml::table* table_;
};

/// Parses a file's text. Throws InputError "path:line: no TOML: why".
toml::table parse_toml(const std::string& text, const std::string& path);

/// Text in quotes with TOML's escapes.
std::string toml_string(const std::string& text);
/// Shortest digits that read back to the same double, always with point or exponent.
std::string toml_number(double value);

}  // namespace palmar::formats
