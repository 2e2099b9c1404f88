// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli.h"

namespace palmar::cli {

/// `palmar mri surfaces`, `motion`: single steps of `palmar hand from-mri`.
void add_mri_steps(CLI::App& mri, Context& context);

}  // namespace palmar::cli
