// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "palmar/geometry/rigid3.h"

namespace palmar::records {

/// A placement as it stands in a grasp's JSON: {"quaternion_wxyz": [4], "translation_mm": [3]}, or
/// "matrix_rows_mm" (4 x 4) alone. Throws InputError without the file's name: a member is missing
/// or has another size, a number isn't finite, the quaternion's length isn't 1 within 1 %, the
/// matrix is no rotation with a translation.
geometry::Rigid3 placement_from_json(const nlohmann::json& json);

/// As it stands there: "quaternion_wxyz", "translation_mm" and "matrix_rows_mm".
nlohmann::ordered_json placement_with_matrix(const geometry::Rigid3& product_from_hand);

}  // namespace palmar::records
