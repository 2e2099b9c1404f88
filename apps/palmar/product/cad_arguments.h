// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "cli.h"
#include "palmar/records/product/product_file.h"

namespace palmar::cli {

/// What is said of CAD files on the command line: --chordal-error-mm, --time-limit-s,
/// --memory-limit-mb.
struct CadArguments {
  std::optional<double> chordal_error;  ///< mm
  records::CadLimits limits;

  void add_to(CLI::App& verb);
  /// Throws UsageError on a limit outside what is allowed.
  records::LoadProductOptions options(const std::string& unit) const;
};

}  // namespace palmar::cli
