// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hands/capture/mri/scan_surfaces.h"
#include "palmar/core/progress.h"
#include "palmar/report/picture/image.h"

namespace palmar::person_report {

/// One sheet of the bones that were found in an image, before anything is computed on them: from
/// the hand's two broad sides, with a number on every bone that is seen from there, and a list of
/// names. Bones without a name are purple. The surfaces have a skin. `progress` may cancel.
report::Image found_bones_sheet(const capture::ScanSurfaces& surfaces,
                                const Progress& progress = {});

/// The same bones, by these numbers, as a file that read_person() reads: names and a point in each.
std::string found_bones_toml(const capture::ScanSurfaces& surfaces);

}  // namespace palmar::person_report
