// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli.h"

namespace palmar::cli {

/// Adds `make` and its kinds to the noun `product`.
void add_product_make_command(CLI::App& product, Context& context);

}  // namespace palmar::cli
