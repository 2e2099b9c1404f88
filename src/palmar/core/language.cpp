// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/core/language.h"

#include "palmar/core/error.h"

namespace palmar {

std::string_view name_of(Language language) { return language == Language::kGerman ? "de" : "en"; }

Language language_named(const std::string& name) {
  for (const Language language : {Language::kEnglish, Language::kGerman}) {
    if (name == name_of(language)) return language;
  }
  throw UsageError("setting \"language\" is \"" + name + "\"; en or de is allowed");
}

}  // namespace palmar
