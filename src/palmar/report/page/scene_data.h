// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/core/language.h"
#include "palmar/report/picture/colour_bar.h"
#include "palmar/study/assessment/assessment.h"

namespace palmar::report {

/// The meshes of one grasp as JSON for the report's 3-D view (SceneData in
/// apps/workbench/viewer/viewer.ts): skin deformed and undeformed, product with footprint, product
/// frame, mm. For display only: positions and pressures are rounded to 1/65535 of their range
/// (base64 of little-endian uint16), which is some 0.005 mm; hand.vtp and product.vtp hold them in
/// full. With them go the region of every skin vertex and the face of every triangle of the
/// product, in words of the language, for what is pointed at; no faces where the product is shown
/// coarser.
std::string scene_data_json(const hand::Hand& hand, const study::AssessedProduct& assessed,
                            const ColourScale& scale, Language language = Language::kEnglish);

}  // namespace palmar::report
