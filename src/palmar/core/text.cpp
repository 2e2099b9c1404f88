// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/core/text.h"

#include <array>
#include <cctype>
#include <cstdio>
#include <cstring>

namespace palmar {

std::string significant(double value, int digits) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*g", digits, value);
  return text.data();
}

std::string counted(int count, std::string_view one, std::string_view many) {
  return std::to_string(count) + " " + std::string(count == 1 ? one : many);
}

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == text.npos) return "";
  return std::string(text.substr(first, text.find_last_not_of(" \t") - first + 1));
}

std::string joined(std::span<const std::string> words, std::string_view between) {
  std::string text;
  for (const std::string& word : words) {
    if (&word != &words.front()) text += between;
    text += word;
  }
  return text;
}

std::string shell_word(const std::string& word) {
  bool is_plain = !word.empty(), has_control = false;
  for (const char c : word) {
    const auto byte = static_cast<unsigned char>(c);
    is_plain = is_plain && (std::isalnum(byte) != 0 || std::strchr("_-./:,=+@%", c) != nullptr);
    has_control = has_control || byte < 0x20;
  }
  if (is_plain) return word;
  // A line break would end a comment that the command line stands in.
  std::string quoted = has_control ? "$'" : "'";
  for (const char c : word) {
    if (static_cast<unsigned char>(c) < 0x20) {
      std::array<char, 8> code{};
      std::snprintf(code.data(), code.size(), "\\x%02x", static_cast<unsigned>(c));
      quoted += code.data();
    } else if (has_control && (c == '\'' || c == '\\')) {
      quoted += std::string("\\") + c;
    } else {
      quoted += c == '\'' ? "'\\''" : std::string(1, c);
    }
  }
  return quoted + "'";
}

}  // namespace palmar
