// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "palmar/workflow/hand/load_hand.h"
#include "palmar/workflow/live/live_session.h"

namespace palmar::workflow {

/// "woman:P5", "man:P97.5": a person by sex and percentile, as `palmar assess --person` takes it.
/// Throws UsageError.
PersonOfSize parse_person_of_size(const std::string& text);
/// The same back.
std::string person_argument(const PersonOfSize& person);

/// What is asked of that person's hand: where nothing is said about how firmly, a person of a size
/// grips with the usual share of her own strength, as `palmar assess --person` takes it.
LiveTask task_of_person(LiveTask task, const std::optional<PersonOfSize>& person);

}  // namespace palmar::workflow
