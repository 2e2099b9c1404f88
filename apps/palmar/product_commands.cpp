// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "cli.h"

namespace palmar::cli {

void add_product_commands(CLI::App&, Context&) {}

}  // namespace palmar::cli
