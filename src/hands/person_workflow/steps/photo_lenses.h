// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "hands/person_records/photo_set.h"
#include "hands/person_records/photo_worker.h"
#include "palmar/core/progress.h"

namespace palmar::person_workflow {

/// Lens of every camera of a set from what its photographs show of the board. `what` the set is
/// called stands before messages. Throws InputError, also if photographs of one camera have unlike
/// sizes.
person_records::PhotoLenses calibrate_lenses(const person_records::PhotoSet& set,
                                             const std::vector<person_records::BoardSighting>& seen,
                                             const std::string& what);

/// What is known loosely of them, for the user: a line per camera, `advice` behind it.
std::vector<std::string> loose_lenses(const person_records::PhotoLenses& lenses,
                                      const std::string& advice);

/// Lenses of a file of `palmar photos calibrate`, or of a folder of photographs of the board.
person_records::PhotoLenses lenses_of(const std::string& path, const Progress& progress);

}  // namespace palmar::person_workflow
