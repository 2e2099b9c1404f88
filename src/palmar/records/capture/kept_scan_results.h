// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/capture/mri/measured_joints.h"
#include "palmar/capture/scan/scanned_hand.h"

namespace palmar {

// What later steps made of scans' surfaces, for another run to take up. A key says what went into
// it (a digest); a file that is missing, damaged or has another key gives nothing, so the step is
// done again. What is given back is bit for bit what was kept. Writing throws OutputError.

/// Of all that later steps use of a scan: skin, bones, names, markers, side.
std::string digest_of(const ScanSurfaces& surfaces);

/// FOLDER/motions.json: how bones moved from the reference scan to this one.
void keep_bone_motions(const std::string& folder, const std::string& key,
                       const std::vector<BoneMotion>& motions);
std::optional<std::vector<BoneMotion>> kept_bone_motions(const std::string& folder,
                                                         const std::string& key);

/// FOLDER/hand.glb and hand.json.
void keep_scanned_hand(const std::string& folder, const std::string& key,
                       const ScannedHand& scanned);
std::optional<ScannedHand> kept_scanned_hand(const std::string& folder, const std::string& key);

}  // namespace palmar
