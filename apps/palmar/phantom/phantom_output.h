// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli.h"
#include "palmar/capture/mri/scan_posture.h"

namespace palmar::cli {

/// Says what `palmar phantom` made: `text`, a line per scan, and where the truth lies; or all as
/// JSON.
void print_made_scans(const Context& context, const std::string& subject, Side side,
                      const nlohmann::ordered_json& scans, const std::string& text,
                      const std::string& truth);

/// Postures of the given names in the order of the enumeration, each once; all without names.
/// Throws UsageError naming --postures and the nearest name.
std::vector<ScanPosture> chosen_postures(const std::vector<std::string>& names);

}  // namespace palmar::cli
