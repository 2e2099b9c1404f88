// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/contact/press.h"

namespace palmar {

/// What `palmar contact press --json` prints: {"steps": [{"depth_mm", "force_n",
/// "contact_area_mm2", "peak_pressure_mpa", "peak_pressure_cells_mpa", "mean_pressure_mpa", ...}],
/// "versions"}. Numbers read back exactly.
std::string press_json(const std::vector<PressStep>& steps);

}  // namespace palmar
