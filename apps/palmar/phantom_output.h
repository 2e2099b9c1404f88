// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "cli.h"

namespace palmar::cli {

/// Says what `palmar phantom` made: `text`, a line per scan, and where the truth lies; or all as
/// JSON.
void print_made_scans(const Context& context, const std::string& subject, Side side,
                      const nlohmann::ordered_json& scans, const std::string& text,
                      const std::string& truth);

}  // namespace palmar::cli
