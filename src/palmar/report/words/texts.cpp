// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/words/texts.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "palmar/report/words/page_parts.h"
#include "palmar/report/words/plain_words.h"

namespace palmar::report {

Texts::Texts(Language language) : language_(language) {
  const std::string_view text = language == Language::kGerman ? german_texts() : english_texts();
  const nlohmann::json all = nlohmann::json::parse(text);
  for (const auto& [key, sentence] : all.items()) {
    sentences_.emplace(key, sentence.get<std::string>());
  }
}

std::string Texts::operator()(const std::string& key, const TextValues& values) const {
  const auto found = sentences_.find(key);
  if (found == sentences_.end()) throw std::logic_error("texts: no sentence \"" + key + "\"");
  const std::string& sentence = found->second;
  std::string out;
  for (std::size_t i = 0; i < sentence.size();) {
    const std::size_t end = sentence[i] == '{' ? sentence.find('}', i) : std::string::npos;
    if (end == std::string::npos) {
      out += sentence[i++];
      continue;
    }
    const std::string name = sentence.substr(i + 1, end - i - 1);
    const auto value = values.find(name);
    if (value == values.end()) {
      throw std::logic_error("texts: \"" + key + "\" has no value for {" + name + "}");
    }
    out += value->second;
    i = end + 1;
  }
  return out;
}

std::string Texts::number(double value, int significant) const {
  std::string text = short_number(value, significant);
  if (language_ == Language::kGerman) std::replace(text.begin(), text.end(), '.', ',');
  return text;
}

std::string Texts::percent(double share) const { return number(100.0 * std::abs(share), 2); }

std::string Texts::listed(const std::vector<std::string>& words) const {
  const std::string last = language_ == Language::kGerman ? " und " : " and ";
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    text += i == 0 ? "" : i + 1 == words.size() ? last : ", ";
    text += words[i];
  }
  return text;
}

}  // namespace palmar::report
