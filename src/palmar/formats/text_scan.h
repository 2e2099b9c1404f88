// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace palmar::formats {

/// Number as written in mesh files, independent of the locale; "+1.5", "nan" and "inf" are numbers.
/// Too large gives infinity, too small 0. Nothing if any character is left over.
std::optional<double> parse_double(std::string_view text);

/// Decimal integer with optional sign; nothing if it doesn't fit or any character is left over.
std::optional<long long> parse_integer(std::string_view text);

/// Shortest text that reads back to the same double.
std::string shortest(double value);

/// Text in quotes for a message: at most 40 characters, control characters as '?'.
std::string in_quotes(std::string_view text);

/// Text for elements and attributes of XML: & < > " as entities.
std::string xml_escaped(std::string_view text);

/// True if the first bytes look like text (no control characters but white space).
bool looks_like_text(std::string_view bytes);

/// Walks through text by white-space separated words or by lines (LF, CRLF or CR) and counts lines.
class TextScanner {
 public:
  explicit TextScanner(std::string_view text) : text_(text) {}

  /// Next word, or nothing at the end.
  std::optional<std::string_view> next_word();
  /// Rest of the current line without its end; nothing at the end of the text.
  std::optional<std::string_view> next_line();
  /// Line of the word or line given last, from 1.
  int line() const { return line_; }
  /// Byte offset behind what was given last.
  std::size_t position() const { return position_; }

 private:
  void count_line_end();

  std::string_view text_;
  std::size_t position_ = 0;
  int line_ = 1;
  int next_line_number_ = 1;
};

}  // namespace palmar::formats
