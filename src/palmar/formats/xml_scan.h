// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace palmar::formats {

/// A start or end tag. Views point into the scanned text; the scanner reuses the tag.
struct XmlTag {
  std::string_view name;  ///< without prefix: "vertex" of <m:vertex>
  bool is_start = false;  ///< <name ...> or <name .../>
  bool is_end = false;    ///< </name> or <name .../>
  std::vector<std::pair<std::string_view, std::string_view>> attributes;  ///< names as written

  /// Value as written, without entity replacement; nothing if there is no such attribute.
  std::optional<std::string_view> attribute(std::string_view attribute_name) const;
  /// The same, ignoring a prefix of the name: "path" finds p:path.
  std::optional<std::string_view> local_attribute(std::string_view attribute_name) const;
};

/// Walks through the tags of an XML text and skips all else: text, comments, processing
/// instructions, CDATA. Checks no nesting. Throws InputError "`name`:line: ..." on a broken tag and
/// on a document type definition (3MF forbids them; they are how XML files attack readers).
class XmlScanner {
 public:
  XmlScanner(std::string_view text, std::string name) : text_(text), name_(std::move(name)) {}

  /// The next tag, or null at the end. Valid until the next call.
  const XmlTag* next();
  /// "name:line" of the tag given last, for messages.
  std::string place() const;

 private:
  [[noreturn]] void fail(const std::string& what) const;
  void skip_past(std::string_view end, const std::string& what);
  void read_attributes();

  std::string_view text_;
  std::string name_;
  std::size_t position_ = 0;
  std::size_t tag_start_ = 0;
  mutable std::size_t counted_to_ = 0;  ///< lines are counted only when asked for
  mutable std::ptrdiff_t counted_lines_ = 0;
  XmlTag tag_;
};

}  // namespace palmar::formats
