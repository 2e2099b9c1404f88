// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hands/capture/sheet/sheet_view.h"

namespace palmar::capture {

/// Finds a bank card (card_format()) that lies beside a hand on a plain table. What has another
/// colour than most of the picture, or is much brighter or darker than shadow, isn't table; a part
/// of it with four straight edges in a card's proportion is the card, the largest other one the
/// hand. The camera's place is fitted to the card's edges, with the focal length given, as a
/// homography of something so small shows too little of where a hand beside it lies:
///
///     sum_k (distance of each edge line's ends from the edge's picture / 0.3 px)^2
///         + (tilt / 12 deg)^2   least.
///
/// The view's frame lies on the table: the card's middle the origin, its lower edge (-y) the one
/// that faces the forearm. `scale_error` follows from the same sum. Throws InputError `name`: no
/// card or several; one that isn't wholly seen; no hand, or one whose forearm doesn't leave the
/// picture; a card that is oblique to the forearm; too oblique.
SheetView find_card(const geometry::RgbImage& image, const std::string& name,
                    const SheetOptions& options = {});

}  // namespace palmar::capture
