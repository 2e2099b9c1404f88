// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/words/person_words.h"

#include <algorithm>

#include "palmar/core/error.h"
#include "palmar/formats/text_scan.h"

namespace palmar::workflow {
namespace {

struct PersonWords {
  grasp::PersonOfAge strength;
  std::optional<double> percentile;  ///< of hand size
};

/// Also as it was once: "male,30". Throws UsageError.
PersonWords person_words(const std::string& text) {
  const std::size_t end = text.find_first_of(":,");
  const std::string sex = text.substr(0, end);
  PersonWords person;
  person.strength.age = grasp::kUsualAge;
  const bool is_woman = sex == "woman" || sex == "female";
  bool is_known = is_woman || sex == "man" || sex == "male";
  person.strength.sex = is_woman ? grasp::Sex::kFemale : grasp::Sex::kMale;
  std::size_t start = end == text.npos ? text.size() : end + 1;
  while (is_known && start < text.size()) {
    const std::size_t comma = std::min(text.find(',', start), text.size());
    const std::string part = text.substr(start, comma - start);
    const bool is_percentile = part.starts_with('P') || part.starts_with('p');
    const bool is_age = part.starts_with("age=");
    const auto number = formats::parse_double(part.substr(is_percentile ? 1 : is_age ? 4 : 0));
    is_known = number.has_value();
    if (is_known && is_percentile) {
      person.percentile = *number;
    } else if (is_known) {
      person.strength.age = *number;
    }
    start = comma + 1;
  }
  if (!is_known) {
    throw UsageError("setting \"person\" is \"" + text +
                     "\"; woman or man is required, with a percentile of hand size, an age, or "
                     "both: woman:P5, man:P50,age=60, woman:age=64");
  }
  return person;
}

}  // namespace

grasp::PersonOfAge parse_person(const std::string& text) { return person_words(text).strength; }

std::optional<PersonOfSize> parse_person_size(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const PersonWords person = person_words(text);
  if (!person.percentile) return std::nullopt;
  const PersonOfSize size{person.strength.sex, *person.percentile};
  size.check();
  return size;
}

grasp::RestSettings held_by(const std::string& text, grasp::RestSettings settings) {
  if (text.empty()) return settings;
  const PersonWords person = person_words(text);
  const bool is_force_said = settings.grip_force || grasp::says_how_firmly(settings.task) ||
                             settings.limit_depths || !settings.is_balanced;
  if (is_force_said && person.percentile) return settings;
  settings.person = person.strength;
  if (!settings.strength_share && person.percentile) {
    settings.strength_share = grasp::kUsualStrengthShare;
    settings.is_share_usual = true;
  }
  return settings;
}

}  // namespace palmar::workflow
