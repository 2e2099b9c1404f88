// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hands/capture/sheet/sheet_grid.h"
#include "hands/imaging/distance_transform.h"

namespace palmar::capture {

/// Cells of the hand: what is redder in its light than half way from paper or table to skin
/// (separated by Otsu's method; shadows are as grey as what they fall on), the largest part, holes
/// filled. Throws InputError `name`: no hand, or none that is redder than the table; fingers that
/// touch; a hand that the picture's border cuts off.
imaging::VoxelMask skin_mask(const RectifiedSheet& sheet, Ground ground, const std::string& name);

}  // namespace palmar::capture
