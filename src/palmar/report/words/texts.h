// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "palmar/core/language.h"

namespace palmar::report {

/// Values for the places of a sentence: {"force", "60"} for "{force}".
using TextValues = std::map<std::string, std::string>;

/// The sentences of reports in one language (apps/workbench/texts), which pages share.
class Texts {
 public:
  explicit Texts(Language language);

  /// The sentence with its values put in. Throws std::logic_error if there is no such key or if a
  /// place of the sentence has no value: a mistake of the program.
  std::string operator()(const std::string& key, const TextValues& values = {}) const;
  bool has(const std::string& key) const { return sentences_.contains(key); }
  Language language() const { return language_; }

  /// A number with so many significant digits (short_number()) and the language's decimal sign.
  std::string number(double value, int significant = 3) const;
  /// The amount of a share in percent, without sign and unit: -0.274 -> "27".
  std::string percent(double share) const;
  /// "a, b and c"
  std::string listed(const std::vector<std::string>& words) const;

 private:
  Language language_;
  std::map<std::string, std::string, std::less<>> sentences_;
};

}  // namespace palmar::report
