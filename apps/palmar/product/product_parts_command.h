// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli.h"

namespace palmar::cli {

/// `palmar product parts`.
void add_product_parts_command(CLI::App& product, Context& context);

}  // namespace palmar::cli
