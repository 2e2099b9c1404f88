// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli.h"

namespace palmar::cli {

/// `palmar mri`: what is in MR images, and single steps of `palmar hand from-mri`.
void add_mri_commands(CLI::App& app, Context& context);

}  // namespace palmar::cli
