// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "hands/capture/mri/scan_surfaces.h"

namespace palmar::person_records {

/// Skin, bones and markers of one scan in a folder, so that any mesh program shows them and the
/// next step takes them up: `skin.ply`, `bones/NAME.ply` (patient frame, mm) and `scan.json`.
///
/// `key` says what they were made from (a digest of image and options); `scan.json` is written last
/// and replaced first, so a folder that has it is whole. Throws OutputError.
void write_scan_surfaces(const std::string& folder, const capture::ScanSurfaces& surfaces,
                         const std::string& key);

/// The key of a folder that is whole, "" if there is none.
std::string key_of_scan_surfaces(const std::string& folder);

/// Throws InputError naming the file and what is wrong with it.
capture::ScanSurfaces read_scan_surfaces(const std::string& folder);

}  // namespace palmar::person_records
