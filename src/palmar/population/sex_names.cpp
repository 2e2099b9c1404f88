// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/population/sex_names.h"

#include "palmar/core/text.h"

namespace palmar::population {

std::string name_of(grasp::Sex sex) { return sex == grasp::Sex::kMale ? "male" : "female"; }

std::string people_of(grasp::Sex sex) { return sex == grasp::Sex::kMale ? "men" : "women"; }

std::optional<grasp::Sex> sex_named(std::string_view name) {
  if (name == "male") return grasp::Sex::kMale;
  if (name == "female") return grasp::Sex::kFemale;
  return std::nullopt;
}

std::optional<grasp::Sex> sex_of_text(std::string_view text) {
  const std::string word = lower_case(text);
  for (const char* male : {"m", "male", "males", "man", "men", "boy", "boys"}) {
    if (word == male) return grasp::Sex::kMale;
  }
  for (const char* female : {"f", "female", "females", "w", "woman", "women", "girl", "girls"}) {
    if (word == female) return grasp::Sex::kFemale;
  }
  return std::nullopt;
}

}  // namespace palmar::population
