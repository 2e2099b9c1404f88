// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli.h"

namespace palmar::cli {

/// Adds `grasp fit-holds`: the weights of the choice of a hold from people's holds.
void add_grasp_fit_holds(CLI::App& grasp, Context& context);

}  // namespace palmar::cli
