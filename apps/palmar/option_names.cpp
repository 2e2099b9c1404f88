// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "option_names.h"

#include <algorithm>
#include <cctype>

#include "palmar/core/error.h"

namespace palmar::cli {
namespace {

bool is_part_of_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
}

bool is_word_at(const std::string& text, std::size_t at, const std::string& word) {
  if (text.compare(at, word.size(), word) != 0) return false;
  const std::size_t end = at + word.size();
  return (at == 0 || !is_part_of_word(text[at - 1])) &&
         (end == text.size() || !is_part_of_word(text[end]));
}

}  // namespace

std::string with_option_names(const std::string& message, const OptionNames& names) {
  std::string text;
  std::size_t at = 0;
  while (true) {
    const std::size_t open = message.find('`', at);
    const std::size_t close = open == message.npos ? open : message.find('`', open + 1);
    if (close == message.npos) return text + message.substr(at);
    text += message.substr(at, open - at);
    const std::string field = message.substr(open + 1, close - open - 1);
    const auto name = std::find_if(names.begin(), names.end(),
                                   [&](const auto& one) { return one.first == field; });
    text += name == names.end() ? field : name->second;
    at = close + 1;
  }
}

void check_as_options(const std::function<void()>& check, const OptionNames& names) {
  try {
    check();
  } catch (const UsageError& error) {
    const std::string text = error.what();
    std::string said;
    for (std::size_t at = 0; at < text.size();) {
      const auto* found = &names.front();
      const auto* const end = names.data() + names.size();
      while (found != end && !is_word_at(text, at, found->first)) ++found;
      said += found == end ? text.substr(at, 1) : found->second;
      at += found == end ? 1 : found->first.size();
    }
    throw UsageError(said);
  }
}

}  // namespace palmar::cli
