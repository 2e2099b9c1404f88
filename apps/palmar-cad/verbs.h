// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "palmar/core/progress.h"

namespace palmar::cad_worker {

using Json = nlohmann::ordered_json;

// The verbs: what request.json asks for becomes reply.json, beside files in `folder`. Lengths in
// mm, keys with their unit. They throw palmar::Error; everything else that is thrown, crashes and
// signals are told by the parent. One file each.

}  // namespace palmar::cad_worker
