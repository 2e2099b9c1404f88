// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli.h"

namespace palmar::cli {

/// `palmar hand quick`: a hand from a few measures, or one photograph of the hand on a sheet of
/// paper, and a population.
void add_hand_quick(CLI::App& hand, Context& context);

}  // namespace palmar::cli
