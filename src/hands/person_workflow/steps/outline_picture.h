// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hands/capture/sheet/hand_outline.h"

namespace palmar::person_workflow {

/// A PNG of the photograph with sheet or card, outline, fingers' middle lines and wrist drawn on
/// it; `model`: the outline of the hand that it was measured against, or null.
std::string outline_picture(const geometry::RgbImage& photograph, const capture::SheetView& sheet,
                            const capture::HandOutline& outline,
                            const capture::HandOutline* model = nullptr);

}  // namespace palmar::person_workflow
