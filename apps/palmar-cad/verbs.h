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
// signals are reported by the parent. One file each.
Json convert(const Json& request, const std::filesystem::path& folder, const Progress& progress);
Json check(const Json& request, const std::filesystem::path& folder, const Progress& progress);
Json features(const Json& request, const std::filesystem::path& folder, const Progress& progress);
Json handle(const Json& request, const std::filesystem::path& folder, const Progress& progress);
Json import(const Json& request, const std::filesystem::path& folder, const Progress& progress);
Json make(const Json& request, const std::filesystem::path& folder, const Progress& progress);
Json region(const Json& request, const std::filesystem::path& folder, const Progress& progress);
Json version(const Json& request, const std::filesystem::path& folder, const Progress& progress);

}  // namespace palmar::cad_worker
