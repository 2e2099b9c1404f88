// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace palmar::geometry {

/// Length unit of a file. Inside Palmar everything is mm.
enum class LengthUnit { kMillimetre, kCentimetre, kMetre, kInch };
std::string name_of(LengthUnit unit);     ///< "mm", "cm", "m", "inch"
double millimetres_per(LengthUnit unit);  ///< 1, 10, 1000, 25.4
/// From "mm", "cm", "m", "in" and the words of these ("inch", "metre", "meters"), in any case of
/// letters; nothing from others.
std::optional<LengthUnit> length_unit_named(std::string_view name);
/// The same. Throws UsageError naming what is allowed.
LengthUnit length_unit(const std::string& name);

}  // namespace palmar::geometry
