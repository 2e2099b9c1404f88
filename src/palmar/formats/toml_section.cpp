// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/toml_section.h"

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/core/nearest_name.h"
#include "palmar/core/text.h"
#include "palmar/formats/text_scan.h"

namespace palmar::formats {
namespace {

std::string with_unit(double value, std::string_view unit) {
  return shortest(value) + (unit.empty() ? "" : " ") + std::string(unit);
}

/// Parts of one dotted key; toml++ limits nested values, but a table nested deeper than this by its
/// key would end the program when it is freed.
constexpr int kMostKeyParts = 100;

/// Throws InputError at a key of more than kMostKeyParts parts. Counts dots between parts of bare
/// or quoted keys; numbers and texts have fewer.
void check_key_depth(const std::string& text, const std::string& path) {
  int line = 1, dots = 0;
  char before = ' ';
  for (const char c : text) {
    if (c == '\n') ++line;
    const bool part_of_key = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' ||
                             c == '-' || c == '"' || c == '\'' || c == ' ' || c == '\t';
    if (c == '.' && before != '.')
      ++dots;
    else if (!part_of_key)
      dots = 0;
    before = c;
    if (dots >= kMostKeyParts) {
      throw InputError(path + ":" + std::to_string(line) + ": no TOML: a key has more than " +
                       std::to_string(kMostKeyParts) + " parts; " + std::to_string(kMostKeyParts) +
                       " are allowed");
    }
  }
}

}  // namespace

TomlSection::TomlSection(std::string path, std::string name, const toml::table& table)
    : path_(std::move(path)), name_(std::move(name)), table_(&table) {}

const toml::node* TomlSection::find(std::string_view key) const { return table_->get(key); }

bool TomlSection::has(std::string_view key) const { return find(key) != nullptr; }

std::string TomlSection::label(std::string_view key) const {
  return (name_.empty() ? "" : name_ + " ") + std::string(key);
}

void TomlSection::fail(const std::string& why) const {
  const auto line = std::max<std::uint32_t>(1, table_->source().begin.line);
  throw InputError(path_ + ":" + std::to_string(line) + ": " + (name_.empty() ? "" : name_ + ": ") +
                   why);
}

void TomlSection::fail(std::string_view key, const std::string& why) const {
  const auto found = table_->find(key);
  if (found == table_->end()) fail(why);
  const auto line = std::max<std::uint32_t>(1, found->first.source().begin.line);
  throw InputError(path_ + ":" + std::to_string(line) + ": " + label(key) + " " + why);
}

void TomlSection::allow(const std::vector<std::string>& keys) const {
  for (const auto& [key, ignored] : *table_) {
    const std::string name(key.str());
    if (std::find(keys.begin(), keys.end(), name) != keys.end()) continue;
    throw InputError(path_ + ":" + std::to_string(key.source().begin.line) + ": " +
                     (name_.empty() ? "the file" : name_) + ": key " + in_quotes(name) +
                     " is not known; " +
                     did_you_mean(name, keys, "allowed are " + joined(keys, ", ")));
  }
}

double TomlSection::in_range(const toml::node& node, std::string_view key, std::string_view unit,
                             double lowest, double highest) const {
  const std::string allowed = shortest(lowest) + " to " + with_unit(highest, unit) + " is allowed";
  if (!node.is_number()) fail(key, "is no number; " + allowed);
  const double value = *node.value<double>();
  if (!(value >= lowest && value <= highest)) {
    fail(key, "is " + with_unit(value, unit) + "; " + allowed);
  }
  return value;
}

std::optional<double> TomlSection::number(std::string_view key, std::string_view unit,
                                          double lowest, double highest) const {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  return in_range(*node, key, unit, lowest, highest);
}

std::optional<std::int64_t> TomlSection::integer(std::string_view key, std::int64_t lowest,
                                                 std::int64_t highest) const {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const std::string allowed =
      std::to_string(lowest) + " to " + std::to_string(highest) + " is allowed";
  const auto value = node->value_exact<std::int64_t>();
  if (!value) fail(key, "is no whole number; " + allowed);
  if (*value < lowest || *value > highest) {
    fail(key, "is " + std::to_string(*value) + "; " + allowed);
  }
  return value;
}

std::optional<std::string> TomlSection::text(std::string_view key) const {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const auto value = node->value_exact<std::string>();
  if (!value) fail(key, "must be text in quotes");
  return value;
}

std::optional<bool> TomlSection::boolean(std::string_view key) const {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const auto value = node->value_exact<bool>();
  if (!value) fail(key, "must be true or false");
  return value;
}

std::vector<std::string> TomlSection::texts(std::string_view key) const {
  const toml::node* node = find(key);
  if (node == nullptr) return {};
  if (!node->is_array()) fail(key, "must be a list of texts in quotes, as in [\"a\", \"b\"]");
  std::vector<std::string> list;
  for (const toml::node& item : *node->as_array()) {
    const auto value = item.value_exact<std::string>();
    if (!value) fail(key, "must be a list of texts in quotes, as in [\"a\", \"b\"]");
    list.push_back(*value);
  }
  return list;
}

std::vector<double> TomlSection::numbers(std::string_view key, std::string_view unit, double lowest,
                                         double highest) const {
  const toml::node* node = find(key);
  if (node == nullptr) return {};
  if (!node->is_array()) fail(key, "must be a list of numbers, as in [1.0, 2.0]");
  std::vector<double> list;
  for (const toml::node& item : *node->as_array()) {
    list.push_back(in_range(item, key, unit, lowest, highest));
  }
  return list;
}

std::optional<TomlSection> TomlSection::table(std::string_view key) const {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_table()) fail(key, "must be a table of keys and values");
  return TomlSection(path_, label(key), *node->as_table());
}

std::vector<TomlSection> TomlSection::tables(std::string_view key) const {
  const toml::node* node = find(key);
  if (node == nullptr) return {};
  const std::string wanted = "must be tables, each headed [[" + std::string(key) + "]]";
  if (!node->is_array()) fail(key, wanted);
  std::vector<TomlSection> list;
  for (const toml::node& item : *node->as_array()) {
    if (!item.is_table()) fail(key, wanted);
    list.emplace_back(path_, label(key) + " " + std::to_string(list.size() + 1), *item.as_table());
  }
  return list;
}

double TomlSection::need_number(std::string_view key, std::string_view unit, double lowest,
                                double highest) const {
  const auto value = number(key, unit, lowest, highest);
  if (!value) {
    fail("key \"" + std::string(key) + "\" is missing; a number from " + shortest(lowest) + " to " +
         with_unit(highest, unit) + " is required");
  }
  return *value;
}

std::string TomlSection::need_text(std::string_view key) const {
  const auto value = text(key);
  if (!value) fail("key \"" + std::string(key) + "\" is missing; a text in quotes is required");
  return *value;
}

toml::table parse_toml(const std::string& text, const std::string& path) {
  check_key_depth(text, path);
  try {
    return toml::parse(text, path);
  } catch (const toml::parse_error& error) {
    throw InputError(path + ":" + std::to_string(error.source().begin.line) +
                     ": no TOML: " + std::string(error.description()));
  }
}

std::string toml_string(const std::string& text) {
  // TOML's basic strings have JSON's escapes; DEL is the one character more that needs one.
  using Json = nlohmann::json;
  std::string quoted = Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
  for (auto at = quoted.find('\x7f'); at != std::string::npos; at = quoted.find('\x7f')) {
    quoted.replace(at, 1, "\\u007f");
  }
  return quoted;
}

std::string toml_number(double value) {
  const std::string digits = shortest(value);
  return digits.find_first_of(".en") != std::string::npos ? digits : digits + ".0";
}

}  // namespace palmar::formats
