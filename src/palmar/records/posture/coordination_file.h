// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/grasp/indices/coordination.h"

namespace palmar::records {

/// The basis of natural coordination from a file of measured grasp postures, in place of the
/// built-in one: CSV (or JSON) as read_postures() has it, one posture per row, with a column for
/// each of the 20 joint angles of the digits (index_pip_flexion_deg ...); those of the wrist are
/// ignored. Angles beyond the hand's range of motion are held to it.
///
/// Throws InputError as read_postures() does, naming file, line, column and value; and naming the
/// file, the row and what is missing: an angle, or rows (at least kLeastPostures).
grasp::CoordinationBasis read_coordination(const std::string& path, const hand::Skeleton& skeleton);

}  // namespace palmar::records
