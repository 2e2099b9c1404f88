// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli.h"

namespace palmar::cli {

/// Adds `hand scale`: a hand of given dimensions, of a row of a table, or times one factor.
void add_hand_scale(CLI::App& hand, Context& context);

}  // namespace palmar::cli
