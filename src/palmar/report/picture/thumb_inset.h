// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/core/progress.h"
#include "palmar/hand/hand.h"
#include "palmar/report/picture/image.h"
#include "palmar/report/picture/render.h"

namespace palmar::report {

/// Camera that looks straight at the pad of the thumb of a hand in its reference posture, the
/// thumb's tip upwards; the thumb and its ball fill the picture. Seen from the palm, the thumb
/// shows its side: what its pad carries can't be seen there.
Camera thumb_pad_camera(const hand::Hand& hand, double aspect);

/// Draws that view of `open_hand` (the skin of `hand` as in its reference posture, coloured) into
/// the lower left of a picture of the opened hand, under `title`. Throws Cancelled.
void add_thumb_inset(Image& picture, const hand::Hand& hand, const Scene& open_hand,
                     const std::string& title, const Progress& progress = {});

}  // namespace palmar::report
