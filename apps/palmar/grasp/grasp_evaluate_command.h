// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli.h"

namespace palmar::cli {

/// Adds `grasp evaluate`: contact and indices of a given posture and placement.
void add_grasp_evaluate(CLI::App& grasp, Context& context);

}  // namespace palmar::cli
