// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "palmar/redesign/handle_shape.h"

namespace palmar {

/// A shape as the CAD program is told of it: mm, rad, all digits.
nlohmann::ordered_json handle_shape_json(const HandleShape& shape);
/// Throws nlohmann's exceptions, InputError on outlines that don't fit together.
HandleShape handle_shape_from(const nlohmann::ordered_json& json);

/// Features by name, each in its own unit.
nlohmann::ordered_json features_json(const HandleFeatures& features);

}  // namespace palmar
