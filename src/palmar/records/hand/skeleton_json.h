// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "palmar/hand/hand.h"

namespace palmar::records {

/// The small parts of a hand as JSON, exact (mm, rad, MPa); names as in anatomy.h. For use inside
/// `io` only. The readers throw InputError for unknown names or wrong counts and
/// nlohmann::json::exception for missing keys.
nlohmann::json skeleton_to_json(const hand::Skeleton& skeleton);
hand::Skeleton skeleton_from_json(const nlohmann::json& json);

nlohmann::json dimensions_to_json(const hand::HandDimensions& dimensions);
hand::HandDimensions dimensions_from_json(const nlohmann::json& json);

nlohmann::json tissue_to_json(const hand::Tissue& tissue);
hand::Tissue tissue_from_json(const nlohmann::json& json);

}  // namespace palmar::records
