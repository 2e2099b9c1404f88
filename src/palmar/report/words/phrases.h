// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "palmar/core/language.h"

namespace palmar::report {

/// What lower layers and files say in English ("held by five fingers; the thumb's tip does not
/// touch"), in the language of a report. The sentences stand in the texts of both languages under
/// the same keys "said.*", with places for values; a place whose name begins with n_ takes numbers
/// only, what {grip} and {part} hold must be known. What a place holds is looked up in its turn. Of
/// several sentences that fit, the one with the most letters of its own is taken.
///
/// Text that isn't found is cut at ends of sentences, semicolons and commas, and its parts are
/// looked up; what isn't known stays English.
class Phrases {
 public:
  explicit Phrases(Language language);

  std::string operator()(const std::string& english) const;
  Language language() const { return language_; }

 private:
  struct Template {
    std::vector<std::string> pieces;  ///< what stands between places, one more than names
    std::vector<std::string> names;
    std::string other;  ///< the same sentence in the language, with places
    std::size_t letters = 0;
  };

  std::optional<std::string> found(const std::string& english, int depth) const;
  std::optional<std::string> direct(const std::string& english, int depth) const;
  std::optional<std::string> cut(const std::string& english, int depth) const;

  Language language_;
  std::map<std::string, std::string, std::less<>> whole_;  ///< sentences without places
  std::vector<Template> templates_;                        ///< most letters first
};

}  // namespace palmar::report
