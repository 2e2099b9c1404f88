// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/capture/mri/bones/layer_fit.h"
#include "palmar/geometry/types.h"

namespace palmar {

/// Of a shift of fat so much is seen by fat_shift(): what lies outside the cortex is fat as well in
/// places, and thicknesses are held near those of their surroundings. 0.18 to 0.35 in images of
/// four development seeds.
inline constexpr double kFatShiftShown = 0.25;

/// How far an image shows fat from where water is, mm, in the frame of the bones: fat's protons
/// precess more slowly, and where the read-out's bandwidth is low, marrow lies off its bone. The
/// cortex then looks thinner on one side, as its inner side is marrow's and its outer side isn't:
///
///     thickness = c - kFatShiftShown shift . normal,
///
/// fitted to each bone by least squares; of the bones the median. Rough: within a third, and 0.1 mm
/// of what isn't there (0.25 mm from palm to back, where cortices differ). Zero of fewer than five
/// bones.
Vec3 fat_shift(const std::vector<LayerFit>& bones);

/// The shift that a scanner's settings state, to the side that the bones show; zero where they show
/// less than 0.3 mm.
Vec3 signed_fat_shift(const Vec3& stated, const Vec3& seen);

}  // namespace palmar
