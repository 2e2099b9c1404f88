// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "palmar/grasp/rest/rest_settings.h"
#include "palmar/workflow/hand/load_hand.h"

namespace palmar::workflow {

// A person in words: "woman:P5", "man:P50,age=60", "woman:age=64", "man" (percentile of hand size;
// age in years, 45 if none is given).

/// Whose strength. Throws UsageError.
grasp::PersonOfAge parse_person(const std::string& text);

/// Of "woman:P5" the size, of which "woman:age=64" says nothing; "": nothing. Throws UsageError.
std::optional<PersonOfSize> parse_person_size(const std::string& text);

/// How firmly that person holds: somebody of a size as firmly as `settings` say, else with the
/// usual share of her own strength. Throws UsageError.
grasp::RestSettings held_by(const std::string& person, grasp::RestSettings settings);

}  // namespace palmar::workflow
