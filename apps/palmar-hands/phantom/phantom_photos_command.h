// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli.h"

namespace palmar::cli {

/// `palmar phantom photos`: photographs of a synthetic person's painted hand, with the truth.
void add_phantom_photos_command(CLI::App& phantom, Context& context);

}  // namespace palmar::cli
