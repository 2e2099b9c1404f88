// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "palmar/redesign/handle_body.h"
#include "palmar/redesign/pressed_shape.h"

namespace palmar::redesign {

/// Between which z [mm] hands press on the handle: where 2 and 98 % of a hand's pressures lie, mean
/// over hands, and `hands.spread` more at both ends; within the body. Its bottom and top if nothing
/// is known of where hands press.
std::array<double, 2> gripped_length(const HandleBody& body, const HandsOnHandle& hands);

/// Beyond the gripped length, at the bottom and at the top, how much [mm] is something else than
/// the handle: a tang, a foot, a guard, a neck. 0 where the handle goes on alike: where outlines
/// differ by no more than 1 mm (root mean square round the section) from those of the gripped
/// length, continued straight in every direction; and of ends below 3 mm. What is a quarter thinner
/// or thicker than the handle continued (the gripped sections about as thick as the median one) is
/// something else even where hands press.
std::array<double, 2> other_ends(const HandleBody& body);

/// Of other_ends(), over which the outline is wholly kept, mm: the features begin over kShapeBlend
/// about the end of the grip, but not on a neck, on which fingers may lie.
std::array<double, 2> kept_lengths(const HandleBody& body);

/// Distance from every place of the body's outlines to the faces of `keep_out`, in place of radii,
/// mm, up to 30. Throws UsageError on a face that doesn't exist or doesn't lie on the handle.
HandleOutlines distances_to_faces(const HandleBody& body, const product::Product& product,
                                  const KeepOut& keep_out);

/// Outlines without what is finer than an outline of three or four lobes and 4 mm along it: those
/// of a scan, whose roughness makes no surface that a CAD system goes on with.
HandleOutlines smoothed(const HandleOutlines& outlines);

}  // namespace palmar::redesign
