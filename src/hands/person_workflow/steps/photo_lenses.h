// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "hands/person_records/photo_set.h"
#include "hands/person_records/photo_worker.h"

namespace palmar {

/// Lens of every camera of a set from what its photographs show of the board. `what` the set is
/// called stands before messages. Throws InputError, also if photographs of one camera have unlike
/// sizes.
PhotoLenses calibrate_lenses(const PhotoSet& set, const std::vector<BoardSighting>& seen,
                             const std::string& what);

/// What is known loosely of them, for the user: a line per camera, `advice` behind it.
std::vector<std::string> loose_lenses(const PhotoLenses& lenses, const std::string& advice);

/// Lenses of a file of `palmar photos calibrate`, or of a folder of photographs of the board.
PhotoLenses lenses_of(const std::string& path, const Progress& progress);

}  // namespace palmar
