// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli.h"

namespace palmar::cli {

/// `palmar hand from-scan`: coloured surface scans of one hand to a *.hand.glb, with a report.
void add_from_scan(CLI::App& hand, Context& context);

}  // namespace palmar::cli
