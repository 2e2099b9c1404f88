// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/geometry/mesh/textured_mesh.h"

namespace palmar::cli {

/// "#1e7a3c", or green, blue, red, black, purple or orange as pens have them. Throws UsageError
/// naming the option.
geometry::Srgb parse_colour(const std::string& option, const std::string& text);

}  // namespace palmar::cli
