// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/core/error.h"

namespace palmar::formats {

/// A program that a benchmark, an export or photographs call isn't installed. Exit code 6.
class ProgramMissing : public Error {
 public:
  using Error::Error;
  int exit_code() const override { return 6; }
};

}  // namespace palmar::formats
