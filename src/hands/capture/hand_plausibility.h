// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/hand/hand.h"

namespace palmar::capture {

/// Dimensions of segments that no hand of that size has, as clauses: less than 0.45 times or more
/// than 2.2 times the model's, by the median ratio of all of them. People's fingers differ by a
/// fifth, and creases are 2 mm nearer to each other in some (that much shorter is allowed); what is
/// so far off has its joints in wrong places, or lost its skin.
std::vector<std::string> impossible_dimensions(const hand::HandDimensions& found,
                                               const hand::HandDimensions& model);

}  // namespace palmar::capture
