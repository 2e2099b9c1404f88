// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/text_scan.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>

namespace palmar::formats {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
bool is_line_end(char c) { return c == '\n' || c == '\r'; }

}  // namespace

std::optional<double> parse_double(std::string_view text) {
  if (!text.empty() && text.front() == '+') {
    text.remove_prefix(1);
    if (!text.empty() && text.front() == '-') return std::nullopt;
  }
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size()) return std::nullopt;
  if (error == std::errc::result_out_of_range) {
    const bool tiny = text.find("e-") != text.npos || text.find("E-") != text.npos;
    if (tiny) return 0.0;
    const double infinity = std::numeric_limits<double>::infinity();
    return text.front() == '-' ? -infinity : infinity;
  }
  if (error != std::errc{}) return std::nullopt;
  return value;
}

std::optional<long long> parse_integer(std::string_view text) {
  if (!text.empty() && text.front() == '+') {
    text.remove_prefix(1);
    if (!text.empty() && text.front() == '-') return std::nullopt;
  }
  long long value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::string shortest(double value) {
  std::array<char, 32> buffer;
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return error == std::errc{} ? std::string(buffer.data(), end) : std::string();
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string shown(text.substr(0, kLongest));
  for (char& c : shown) {
    if (static_cast<unsigned char>(c) < 32 || static_cast<unsigned char>(c) > 126) c = '?';
  }
  return "\"" + shown + (text.size() > kLongest ? "...\"" : "\"");
}

std::string xml_escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

bool looks_like_text(std::string_view bytes) {
  const std::string_view start = bytes.substr(0, 1024);
  return std::all_of(start.begin(), start.end(), [](char c) {
    const auto u = static_cast<unsigned char>(c);
    return (u >= 32 && u != 127) || is_blank(c) || is_line_end(c);
  });
}

void TextScanner::count_line_end() {
  if (text_[position_] == '\r' && position_ + 1 < text_.size() && text_[position_ + 1] == '\n') {
    ++position_;
  }
  ++position_;
  ++next_line_number_;
}

std::optional<std::string_view> TextScanner::next_word() {
  while (position_ < text_.size()) {
    if (is_line_end(text_[position_])) {
      count_line_end();
    } else if (is_blank(text_[position_])) {
      ++position_;
    } else {
      break;
    }
  }
  line_ = next_line_number_;
  if (position_ == text_.size()) return std::nullopt;
  const std::size_t start = position_;
  while (position_ < text_.size() && !is_blank(text_[position_]) &&
         !is_line_end(text_[position_])) {
    ++position_;
  }
  return text_.substr(start, position_ - start);
}

std::optional<std::string_view> TextScanner::next_line() {
  line_ = next_line_number_;
  if (position_ >= text_.size()) return std::nullopt;
  const std::size_t start = position_;
  while (position_ < text_.size() && !is_line_end(text_[position_])) ++position_;
  const std::string_view line = text_.substr(start, position_ - start);
  if (position_ < text_.size()) count_line_end();
  return line;
}

}  // namespace palmar::formats
