// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "hands/capture/mri/scan_surfaces.h"

namespace palmar::cli {

/// Options of how surfaces are found in an image, the same for every verb that does so.
class SurfaceArguments {
 public:
  void add_to(CLI::App& verb);
  capture::SurfaceOptions options() const;  ///< throws UsageError naming the option
  std::optional<hand::Side> chosen_side() const;

 private:
  capture::SurfaceOptions options_;
  std::string side_;
  bool keeps_bias_ = false;
};

}  // namespace palmar::cli
