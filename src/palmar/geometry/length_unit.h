// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace palmar {

/// Length unit of a file. Inside Palmar everything is mm.
enum class LengthUnit { kMillimetre, kCentimetre, kMetre, kInch };
std::string name_of(LengthUnit unit);     ///< "mm", "cm", "m", "inch"
double millimetres_per(LengthUnit unit);  ///< 1, 10, 1000, 25.4
/// From "mm", "cm", "m", "inch" or "in". Throws UsageError naming what is allowed.
LengthUnit length_unit(const std::string& name);

}  // namespace palmar
