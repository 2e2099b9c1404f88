// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli.h"
#include "hands/person_workflow/phantom/phantom_postures.h"

namespace palmar::cli {

/// Says what `palmar phantom` made: `text`, a line per scan, and where the truth lies; or all as
/// JSON with `scans`.
void print_made_scans(const Context& context, const person_workflow::PhantomPerson& person,
                      const nlohmann::ordered_json& scans, const std::string& text);

/// Postures of the given names; none without names. Throws UsageError naming --posture and
/// the nearest name.
std::vector<hand::ScanPosture> chosen_postures(const std::vector<std::string>& names);

/// Of --free, which all verbs of palmar phantom have.
inline constexpr const char* kFreeHelp =
    "A person further from the start hand: proportions by surveys, axes 6 degrees off, outline, "
    "webs "
    "and oblique creases of its own, relaxed by its own soft tissue";

}  // namespace palmar::cli
