// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli.h"

namespace palmar::cli {

/// `palmar photos`: the board to print, lenses, and a coloured mesh from photographs of a hand.
void add_photos_commands(CLI::App& app, Context& context);

/// `palmar photos mesh`.
void add_photos_mesh_command(CLI::App& photos, Context& context);

}  // namespace palmar::cli
