// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/hand/anatomy.h"

namespace palmar::cli {

/// "right" or "left"; throws UsageError naming --side.
hand::Side parse_side(const std::string& text);

}  // namespace palmar::cli
