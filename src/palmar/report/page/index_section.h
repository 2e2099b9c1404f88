// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/grasp/indices/grasp_index.h"

namespace palmar {

/// Indices of a grasp for the HTML report: one table per group, each row with value, unit, range
/// and which way is better; definition, source and remark unfold. Empty for no rows.
std::string index_section(const GraspIndices& indices);

/// The indices of several products side by side, a column each; rows by key, in the order of the
/// first product that has them. Empty for less than two products. `names` and `indices` correspond.
std::string index_comparison(const std::vector<std::string>& names,
                             const std::vector<GraspIndices>& indices);

}  // namespace palmar
