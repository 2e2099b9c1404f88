// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli.h"

namespace palmar::cli {

/// `palmar phantom mri`: MR series of a synthetic person, with the truth.
void add_phantom_commands(CLI::App& app, Context& context);

}  // namespace palmar::cli
