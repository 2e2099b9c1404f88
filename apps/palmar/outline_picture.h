// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/photo/hand_outline.h"

namespace palmar::cli {

/// A PNG of the photograph with sheet, outline, fingers' middle lines and wrist drawn on it.
std::string outline_picture(const RgbImage& photograph, const SheetView& sheet,
                            const HandOutline& outline);

}  // namespace palmar::cli
