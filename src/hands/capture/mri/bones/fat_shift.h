// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "hands/capture/mri/bones/layer_fit.h"
#include "palmar/geometry/types.h"

namespace palmar::capture {

/// Of a shift of fat so much is seen by fat_shift(), as thicknesses are held near those of their
/// surroundings: 0.69 and 0.75 in images of two development seeds.
inline constexpr double kFatShiftShown = 0.7;

/// How far an image shows fat from where water is, mm, in the frame of the bones: fat's protons
/// precess more slowly, and where the read-out's bandwidth is low, marrow lies off its bone. The
/// cortex then looks thinner on one side, as its inner side is marrow's and its outer side isn't:
///
///     thickness = c - kFatShiftShown shift . normal,
///
/// fitted to each bone by least squares; of the bones the median. For `bones` of the palm, which
/// muscle and tendons surround: round phalanges there is fat, which moves along. Zero of fewer than
/// five bones.
Vec3 fat_shift(const std::vector<LayerFit>& bones);

/// The shift that a scanner's settings state, to the side that the bones show; without settings
/// (zero) what the bones show. Zero where they show less than 0.3 mm, or a third of what is stated:
/// a file may state a bandwidth that its image wasn't made with.
Vec3 signed_fat_shift(const Vec3& stated, const Vec3& seen);

}  // namespace palmar::capture
