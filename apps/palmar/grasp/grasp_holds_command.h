// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli.h"

namespace palmar::cli {

/// Adds `grasp holds`: ways to hold a product, ranked, as a table, files and one picture sheet.
void add_grasp_holds(CLI::App& grasp, Context& context);

}  // namespace palmar::cli
