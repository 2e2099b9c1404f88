// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/live/live_person.h"

#include <algorithm>

#include "palmar/core/error.h"
#include "palmar/core/text.h"
#include "palmar/formats/text_scan.h"
#include "palmar/grasp/equilibrium/grip_force.h"
#include "palmar/grasp/task_force.h"

namespace palmar::workflow {

PersonOfSize parse_person_of_size(const std::string& text) {
  const std::size_t colon = std::min(text.find(':'), text.size());
  const std::string sex = text.substr(0, colon);
  const bool is_known = (sex == "woman" || sex == "man") && text.substr(colon).starts_with(":P");
  const auto percentile = is_known ? formats::parse_double(text.substr(colon + 2)) : std::nullopt;
  if (!percentile) {
    throw UsageError("person is " + formats::in_quotes(text) +
                     "; woman or man with a percentile is allowed: woman:P5, man:P95");
  }
  const PersonOfSize person{sex == "woman" ? grasp::Sex::kFemale : grasp::Sex::kMale, *percentile};
  person.check();
  return person;
}

std::string person_argument(const PersonOfSize& person) {
  return std::string(person.sex == grasp::Sex::kFemale ? "woman" : "man") + ":P" +
         formats::shortest(person.percentile);
}

LiveTask task_of_person(LiveTask task, const std::optional<PersonOfSize>& person) {
  if (task.rest.is_usual() && person) {
    task.rest.person = grasp::PersonOfAge{person->sex, grasp::kUsualAge};
    task.rest.strength_share = grasp::kUsualStrengthShare;
    task.rest.is_share_usual = true;
  }
  return task;
}

}  // namespace palmar::workflow
