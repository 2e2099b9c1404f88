// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "palmar/grasp/indices/grasp_index.h"

namespace palmar::records {

/// {"epsilon_l1": 0.21, "coordination_distance": null, ...}: value of every index, null where it
/// can't be said; in the order of the rows. What stands as "indices" of an assessment.
nlohmann::ordered_json index_values(const grasp::GraspIndices& indices);

/// [{"key", "name", "group", "value", "unit", "lowest", "highest", "better", "definition",
/// "source", "remark"}, ...]: the rows in full, null where there is no value or no end of the
/// range. What stands as "index_table".
nlohmann::ordered_json index_rows(const grasp::GraspIndices& indices);

/// Table for a terminal: group, name, value with unit, which way is better, and the remark unless
/// the row above has the same. Values with three significant digits and no exponents, columns
/// aligned; ends with a line break, empty for no rows.
std::string index_text(const grasp::GraspIndices& indices);

}  // namespace palmar::records
