// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "palmar/redesign/handle_shape.h"

namespace palmar::redesign {

/// Least distance between a shape's sides and the hollow within the original handle, in the planes
/// of its sections, mm: the wall that would be left if the hollow stayed as it is. Negative where
/// the shape cuts into the hollow. Nothing of a handle that has none.
std::optional<double> thinnest_wall(const HandleShape& shape);

/// The same of the original.
std::optional<double> thinnest_wall(const HandleBody& body);

}  // namespace palmar::redesign
