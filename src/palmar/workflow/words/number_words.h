// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::workflow {

// Numbers and directions as people write them in one word. `what` is what messages call it:
// "--at", or "setting \"at\"" (core/setting_names.h).

/// "0.5,1,2" as numbers. Throws UsageError.
std::vector<double> parse_list(const std::string& what, const std::string& text);
/// "1,2,3" as a vector. Throws UsageError.
Vec3 parse_vector(const std::string& what, const std::string& text);
/// "+x", "-z", "x", "0,0.5,1": a direction in the product's frame, of any length but 0. Throws
/// UsageError.
Vec3 parse_direction(const std::string& what, const std::string& text);

}  // namespace palmar::workflow
