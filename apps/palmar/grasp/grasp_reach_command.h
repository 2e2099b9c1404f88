// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli.h"

namespace palmar::cli {

/// Adds `grasp reach`: which fingers reach buttons without losing the grip; a map of the surface.
void add_grasp_reach(CLI::App& grasp, Context& context);

}  // namespace palmar::cli
