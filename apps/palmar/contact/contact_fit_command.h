// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli.h"

namespace palmar::cli {

/// `palmar contact fit`.
void add_contact_fit_verb(CLI::App& contact, Context& context);

}  // namespace palmar::cli
