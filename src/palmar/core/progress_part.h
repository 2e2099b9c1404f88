// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/core/progress.h"

namespace palmar {

/// The progress of a part of some work, which runs from share `begin` to `end` of the whole. `what`
/// stands before the part's own words, if not empty.
Progress part_of(const Progress& progress, double begin, double end, const std::string& what = "");

}  // namespace palmar
