// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "hands/capture/mri/bones/bone_labels.h"

namespace palmar::person_records {

/// Reads names for bones of a scan: CSV with the columns name, x_mm, y_mm, z_mm (patient frame).
/// Throws InputError naming file, line and column.
std::vector<hand::BoneLabel> read_bone_labels(const std::string& path);

}  // namespace palmar::person_records
