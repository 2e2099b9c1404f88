// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "palmar/geometry/types.h"

namespace palmar::records {

/// [x, y, z].
inline nlohmann::ordered_json vector3(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

/// The value, or null where there is none.
template <typename T>
nlohmann::ordered_json or_null(const std::optional<T>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

/// The same; null for what isn't finite, too, which JSON can't say.
inline nlohmann::ordered_json finite_or_null(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? nlohmann::ordered_json(*value)
                                        : nlohmann::ordered_json(nullptr);
}

/// As a file has it; bytes that are no UTF-8 don't stop it.
inline std::string json_file_text(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace palmar::records
