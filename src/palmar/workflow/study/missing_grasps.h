// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace palmar::workflow {

/// "finished, but 2 grasps are not in it: 3, 5": of a damaged store.
std::string missing_grasps(const std::vector<std::int64_t>& numbers);

}  // namespace palmar::workflow
