// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/report/colour_bar.h"
#include "palmar/study/assessment.h"

namespace palmar {

/// The meshes of one grasp as JSON for the report's 3-D view (SceneData in viewer/viewer.ts): skin
/// deformed and undeformed, product with footprint, pressures in MPa; arrays as base64 of
/// little-endian float32 and uint32, product frame, mm.
std::string scene_data_json(const Hand& hand, const AssessedProduct& assessed,
                            const ColourScale& scale);

}  // namespace palmar
