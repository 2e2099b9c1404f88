// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/records/study/study_store.h"

namespace palmar::records {

/// Writes a study's tables as CSV files into a folder (made if missing), units in the headers:
///
///     hands.csv      one line per hand: whose, and every dimension in mm
///     products.csv   products.csv, settings.csv, profiles.csv: what was varied
///     grasps.csv     one line per finished grasp, names of hand and product beside it
///     indices.csv    one line per grasp, one column per index
///     regions.csv    one line per grasp and region of the hand in contact
///     postures.csv   angles in degrees, placement of the product
///     plan.json      the plan in full
///     skin_pressure.csv, product_pressure.csv   one line per grasp and loaded vertex; on demand
///
/// Same results, same bytes. Memory doesn't grow with the study. Returns the files' paths. Throws
/// OutputError, InputError, Cancelled.
std::vector<std::filesystem::path> export_study(const StudyStore& store,
                                                const std::filesystem::path& folder,
                                                bool with_fields, const Progress& progress = {});

}  // namespace palmar::records
