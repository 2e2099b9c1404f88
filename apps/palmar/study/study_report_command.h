// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli.h"

namespace palmar::cli {

/// `palmar study report` and `palmar study compare`.
void add_study_report_commands(CLI::App& noun, Context& context);

}  // namespace palmar::cli
