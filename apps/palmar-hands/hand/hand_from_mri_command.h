// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli.h"

namespace palmar::cli {

/// `palmar hand from-mri`: MR series of one hand in several postures to a *.hand.glb, with a
/// report.
void add_from_mri(CLI::App& hand, Context& context);

}  // namespace palmar::cli
