// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/records/study/study_file.h"

namespace palmar::records {

/// Populations in one word: what population_request() takes, or people from one size to another:
///
///     woman:P5..woman:P95   women of the 5th, 50th and 95th percentile
///     woman:P5..man:P95     women of the 5th and 50th, men of the 50th and 95th
///
/// of ANSUR II, in all that drives the size of a hand and without scatter. The middle is there if
/// it lies between the ends. "small-to-large" is woman:P5..man:P95. Such hands are chosen, not
/// drawn: their number says nothing about people. Throws UsageError for an end that isn't
/// woman:P1 to man:P99, and for ends in the wrong order.
std::vector<PopulationRequest> population_requests(const std::string& words);

/// Whether these words name given people, so that a number of hands has no meaning.
bool is_people_range(const std::string& words);

}  // namespace palmar::records
