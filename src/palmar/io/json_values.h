// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "palmar/geometry/types.h"

namespace palmar {

/// [x, y, z].
inline nlohmann::ordered_json vector3(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

/// The value, or null where there is none.
template <typename T>
nlohmann::ordered_json or_null(const std::optional<T>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

}  // namespace palmar
