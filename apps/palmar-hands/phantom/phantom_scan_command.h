// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli.h"

namespace palmar::cli {

/// `palmar phantom scan`: coloured surface scans of a painted synthetic person, with the truth.
void add_phantom_scan(CLI::App& phantom, Context& context);

}  // namespace palmar::cli
