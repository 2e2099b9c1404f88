// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace palmar::server {

/// Single grasps of a study's first condition, for charts in which each is a dot:
/// {"products": [{"name", "colour"}], "hands": [{"length_mm", "shown"}], "quantities": [{"key",
/// "name", "unit"}], "grasps": [{"hand", "product", "outcome", "values": [one per quantity, or
/// null]}]}. "hand" counts `hands`; "shown" is the hand's number in the report's 3-D view, null if
/// it isn't among those. Throws InputError naming the store.
std::string study_dots_json(const std::filesystem::path& store);

}  // namespace palmar::server
