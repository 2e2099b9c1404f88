// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/words/phrases.h"

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

#include "palmar/report/words/page_parts.h"
#include "palmar/report/words/plain_words.h"

namespace palmar::report {
namespace {

constexpr int kDeepest = 8;  // places within places

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_number(std::string_view text) {
  if (text.empty()) return false;
  for (const char c : text) {
    if (!is_digit(c) && c != '.' && c != '-' && c != '+' && c != 'e') return false;
  }
  return is_digit(text.back());
}

bool is_verbatim(const std::string& place) {
  return place == "product" || place == "name" || place == "family" || place == "label";
}

/// Whether the text is more than a name: clauses that a place for a name must not swallow.
bool has_clause_end(std::string_view text) {
  return text.find(": ") != text.npos || text.find("; ") != text.npos;
}

/// Words that could be anything: there the sentence fits only if they are known themselves.
bool must_be_known(const std::string& place) {
  return place == "grip" || place == "part" || place == "other";
}

/// 0.25 -> 0,25: a full stop between two digits.
std::string with_decimal_commas(std::string text) {
  for (std::size_t i = 1; i + 1 < text.size(); ++i) {
    if (text[i] == '.' && is_digit(text[i - 1]) && is_digit(text[i + 1])) text[i] = ',';
  }
  return text;
}

/// Whether a sentence ends within the text and another begins. What a place holds is at most one.
bool has_sentence_end(std::string_view text) {
  for (std::size_t at = text.find(". "); at != text.npos; at = text.find(". ", at + 1)) {
    if (at + 2 < text.size() && std::isupper(static_cast<unsigned char>(text[at + 2])) != 0) {
      return true;
    }
  }
  return false;
}

/// "a {b} c" -> pieces "a ", " c" and names "b".
void cut_at_places(const std::string& sentence, std::vector<std::string>& pieces,
                   std::vector<std::string>& names) {
  std::size_t from = 0;
  for (std::size_t open = sentence.find('{'); open != std::string::npos;
       open = sentence.find('{', from)) {
    const std::size_t close = sentence.find('}', open);
    if (close == std::string::npos) break;
    pieces.push_back(sentence.substr(from, open - from));
    names.push_back(sentence.substr(open + 1, close - open - 1));
    from = close + 1;
  }
  pieces.push_back(sentence.substr(from));
}

/// What stands in the places from the k-th on, if the text from `at` on is of that form.
bool fits(const std::string& text, std::size_t at, const std::vector<std::string>& pieces,
          const std::vector<std::string>& names, std::size_t k, std::vector<std::string>& values) {
  if (k == names.size()) return at == text.size();
  const std::string& next = pieces[k + 1];
  const bool is_last = k + 1 == names.size();
  std::size_t end = text.size();
  if (is_last) {
    if (text.size() < at + next.size() + 1 || !text.ends_with(next)) return false;
    end = text.size() - next.size();
  } else {
    end = text.find(next, at + 1);
  }
  for (; end != std::string::npos && end > at; end = text.find(next, end + 1)) {
    const std::string value = text.substr(at, end - at);
    if (names[k].starts_with("n_") && !is_number(value)) {
      if (is_last) return false;
      continue;
    }
    if (is_verbatim(names[k]) ? has_clause_end(value) : has_sentence_end(value)) return false;
    values[k] = value;
    if (fits(text, end + next.size(), pieces, names, k + 1, values)) return true;
    if (is_last) return false;
  }
  return false;
}

std::string with_first(std::string text, bool is_large) {
  if (text.empty()) return text;
  const auto c = static_cast<unsigned char>(text[0]);
  if (c < 128) text[0] = static_cast<char>(is_large ? std::toupper(c) : std::tolower(c));
  return text;
}

std::vector<std::string> parted(const std::string& text, const std::string& at) {
  std::vector<std::string> parts;
  std::size_t from = 0;
  for (std::size_t end = text.find(at); end != std::string::npos; end = text.find(at, from)) {
    parts.push_back(text.substr(from, end - from));
    from = end + at.size();
  }
  parts.push_back(text.substr(from));
  return parts;
}

}  // namespace

Phrases::Phrases(Language language) : language_(language) {
  if (language == Language::kEnglish) return;
  const nlohmann::json english = nlohmann::json::parse(english_texts());
  const nlohmann::json other = nlohmann::json::parse(german_texts());
  for (const auto& [key, sentence] : english.items()) {
    if (!key.starts_with("said.") && !key.starts_with("region.")) continue;
    Template one;
    const auto text = sentence.get<std::string>();
    one.other = other.at(key).get<std::string>();
    cut_at_places(text, one.pieces, one.names);
    if (one.names.empty()) {
      whole_.emplace(text, one.other);
      continue;
    }
    for (const std::string& piece : one.pieces) one.letters += piece.size();
    templates_.push_back(std::move(one));
  }
  std::stable_sort(templates_.begin(), templates_.end(),
                   [](const Template& a, const Template& b) { return a.letters > b.letters; });
}

std::string Phrases::operator()(const std::string& english) const {
  if (language_ == Language::kEnglish || english.empty()) return english;
  return found(english, 0).value_or(english);
}

std::optional<std::string> Phrases::direct(const std::string& english, int depth) const {
  if (depth > kDeepest) return std::nullopt;
  if (const auto whole = whole_.find(english); whole != whole_.end()) return whole->second;
  for (const Template& one : templates_) {
    if (!english.starts_with(one.pieces.front())) continue;
    std::vector<std::string> values(one.names.size());
    if (!fits(english, one.pieces.front().size(), one.pieces, one.names, 0, values)) continue;
    bool are_known = true;
    for (std::size_t k = 0; k < values.size(); ++k) {
      const bool is_needed = must_be_known(one.names[k]);
      const std::optional<std::string> known = is_verbatim(one.names[k]) ? values[k]
                                               : is_needed ? direct(values[k], depth + 1)
                                                           : found(values[k], depth + 1);
      are_known = are_known && (known || !is_needed);
      values[k] = known ? *known : with_decimal_commas(values[k]);
    }
    if (!are_known) continue;
    std::vector<std::string> pieces, names;
    cut_at_places(one.other, pieces, names);
    std::string text = pieces.front();
    for (std::size_t k = 0; k < names.size(); ++k) {
      const auto place = std::find(one.names.begin(), one.names.end(), names[k]);
      text += values.at(static_cast<std::size_t>(place - one.names.begin())) + pieces[k + 1];
    }
    return text;
  }
  return std::nullopt;
}

std::optional<std::string> Phrases::found(const std::string& english, int depth) const {
  if (depth > kDeepest || english.size() < 2) return std::nullopt;
  if (auto known = direct(english, depth)) return known;
  if (english.ends_with('.')) {
    if (const auto known = direct(english.substr(0, english.size() - 1), depth)) {
      return *known + ".";
    }
  }
  if (std::isupper(static_cast<unsigned char>(english[0])) != 0) {
    if (const auto known = direct(with_first(english, false), depth)) {
      return with_first(*known, true);
    }
  }
  return cut(english, depth);
}

std::optional<std::string> Phrases::cut(const std::string& english, int depth) const {
  struct Mark {
    std::string text;
    std::string other;
    bool is_sentence = false, is_list = false, is_heading = false;
  };
  static const std::vector<Mark> marks = {{". ", " ", true, false},
                                          {"; ", "; ", false, false},
                                          {": ", ": ", false, false, true},
                                          {", ", ", ", false, true},
                                          {" and ", " und ", false, true}};
  for (const Mark& mark : marks) {
    std::vector<std::string> parts = parted(english, mark.text);
    if (parts.size() < 2) continue;
    if (mark.is_heading) {  // what follows may have a colon of its own
      parts = {parts.front(), english.substr(parts.front().size() + mark.text.size())};
    }
    std::string text;
    std::size_t known_parts = 0;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const bool is_ended = mark.is_sentence && k + 1 < parts.size();
      const std::string part = parts[k] + (is_ended ? "." : "");
      const std::optional<std::string> known = found(part, depth + 1);
      known_parts += known ? 1 : 0;
      text += (k > 0 ? mark.other : "") + (known ? *known : with_decimal_commas(part));
    }
    if (mark.is_list ? known_parts == parts.size() : known_parts > 0) return text;
  }
  return std::nullopt;
}

}  // namespace palmar::report
