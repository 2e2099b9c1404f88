// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "palmar/redesign/handle_shape.h"

namespace palmar::records {

/// A shape as the CAD program is told of it: mm, rad, all digits.
nlohmann::ordered_json handle_shape_json(const redesign::HandleShape& shape);
/// Throws nlohmann's exceptions, InputError on outlines that don't fit together.
redesign::HandleShape handle_shape_from(const nlohmann::ordered_json& json);

/// Low and high corner: x, y, z, x, y, z.
std::vector<double> corners_of(const Box3& box);
/// Of any two opposite corners. Throws InputError unless there are six coordinates.
Box3 box_of_corners(std::span<const double> corners);

/// Features by name, each in its own unit.
nlohmann::ordered_json features_json(const redesign::HandleFeatures& features);

}  // namespace palmar::records
