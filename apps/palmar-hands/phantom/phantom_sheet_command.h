// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli.h"

namespace palmar::cli {

/// `palmar phantom sheet`: a photograph of a synthetic hand flat on a sheet of paper.
void add_phantom_sheet(CLI::App& phantom, Context& context);

}  // namespace palmar::cli
