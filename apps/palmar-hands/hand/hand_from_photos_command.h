// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli.h"

namespace palmar::cli {

/// `palmar hand from-photos`: photographs of several postures to a hand.
void add_from_photos(CLI::App& hand, Context& context);

}  // namespace palmar::cli
