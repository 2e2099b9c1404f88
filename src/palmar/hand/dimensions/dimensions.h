// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/hand/hand.h"
#include "palmar/hand/skin/creases.h"

namespace palmar::hand {

/// Measures a hand in its reference posture, from exact plane sections of the skin; mm.
///
/// Major dimensions (Xie 2014, fig. 5-3)
/// - L: from the middle of the wrist crease to the tip of the middle finger, in the palm plane
///   (x, y).
/// - C: tape round the hand in the plane through the heads of metacarpals II and V perpendicular to
/// the
///   palm: perimeter of the section's convex hull. The thumb is another curve of that section, or
///   lies proximal of it.
/// - W: breadth of that section along the line from metacarpal head V to II.
/// - T: its thickness, perpendicular to that line, where it passes metacarpal head III.
///
/// Segments (fig. 4-6, 5-4)
/// - Length y: from the middle of the palmar proximal crease to that of the next crease, or to the
///   fingertip, along the line between the creases' centres.
/// - Width x and thickness z: extents, along the flexion axis and perpendicular to it, of the
/// section half
///   way, perpendicular to that line. The thesis doesn't say where along the segment it measured.
/// - Palm: length from the wrist crease to the base crease of the middle finger, along y; width W,
///   thickness T.
///
/// Throws InputError naming the segment if a section misses the skin.
HandDimensions measure_hand(const Hand& hand);

/// The same for a skin that is not yet part of a hand.
HandDimensions measure_hand(const geometry::TriangleMesh& skin, const Skeleton& skeleton);
/// The same from creases that were seen on the skin.
HandDimensions measure_hand(const geometry::TriangleMesh& skin, const Skeleton& skeleton,
                            const HandCreases& creases);

}  // namespace palmar::hand
