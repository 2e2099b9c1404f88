// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "hands/capture/scan/skin_marks.h"
#include "palmar/geometry/rigid3.h"
#include "palmar/hand/skin/drawn_creases.h"

namespace palmar::capture {

/// One drawn line across a finger, or what else is drawn in the creases' ink.
struct CreaseMark {
  Vec3 point = Vec3::Zero();            ///< on it, in its middle; scan, mm
  std::optional<hand::Segment> crease;  ///< taken for the proximal crease of this; palm: the
                                        ///< wrist's
};

/// Creases of a person found in a scan.
struct FoundCreases {
  hand::DrawnCreases plane;
  std::map<hand::Segment, double> shift;  ///< distal of where the joints would put them, at the
                                          ///< middle, mm
  std::vector<hand::Segment> missing;     ///< not drawn, or not found
  int stray = 0;                          ///< drawn vertices that no crease is near
  /// Other lines near the wrist, as broad as a crease: distal of where the joints would put it, mm.
  std::vector<double> other_wrist;
  std::vector<CreaseMark> marks;
};

/// Takes drawn lines for creases, by their order along each finger:
/// - A drawn point belongs to the finger whose bones are nearest, in the palm to the base crease
///   (10 mm) or the wrist's (18 mm) that is near.
/// - Near the wrist bare skin of 3.5 mm along the hand parts lines; the crease is the one nearest
/// to
///   where the joints suggest it.
/// - Points of a finger are put in order along it, s being 0, 1, 2 ... at the creases suggested and
///   linear in the distances from their planes in between; where 3.5 mm are bare one line ends and
///   the next begins. Lines narrower than a third of the finger's breadth don't count.
/// - Lines and creases are paired without crossing, so that the sum of (d / 5 mm)^2, d the distance
///   from line to crease along the finger, is least; one left alone costs 3.
/// - A crease is the plane through its points that stays perpendicular to the finger's palmar
/// direction:
///   offset and slope across the finger by least squares.
/// What `marks` labels by hand comes first. `creases`: where the joints suggest them. Throws
/// InputError "file:line: ..." for labels that contradict each other.
FoundCreases find_creases(const SkinMarks& marks, const geometry::Rigid3& hand_from_scan,
                          const hand::HandCreases& creases);

}  // namespace palmar::capture
