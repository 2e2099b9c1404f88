// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "palmar/geometry/mesh/section.h"
#include "palmar/hand/skin/creases.h"

namespace palmar::hand {

/// Where a phalanx is measured. Hand frame, reference posture, mm.
struct SegmentSection {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();  ///< centres of its two creases; `to`: or the tip
  Vec3 along = Vec3::UnitY();                   ///< unit, from `from` to `to`
  Vec3 across = Vec3::UnitX();                  ///< unit, along the flexion axis
  Vec3 palmar = Vec3::UnitZ();                  ///< unit, perpendicular to both
  Vec3 from_palmar, to_palmar;                  ///< middles of the creases on the palmar skin
  Vec3 from_dorsal, to_dorsal;                  ///< and straight dorsal of their centres
  geometry::SectionCurve middle;                ///< section half way, perpendicular to `along`
};

/// Where the whole hand is measured.
struct HandSections {
  Vec3 wrist_middle = Vec3::Zero();                   ///< of the section in the wrist crease
  Vec3 wrist_palmar, wrist_dorsal;                    ///< skin straight palmar and dorsal of it
  Vec3 radial = Vec3::UnitX();                        ///< unit, from metacarpal head V to II
  Vec3 palmar = Vec3::UnitZ();                        ///< unit, perpendicular to it and to `normal`
  Vec3 normal = Vec3::UnitY();                        ///< of the plane through the metacarpal heads
  geometry::SectionCurve heads;                       ///< round them, the thumb excluded
  std::array<SegmentSection, kSegmentCount> segment;  ///< of the phalanges
};

/// Sections that dimensions.h and tape_measures.h measure. Throws InputError naming the segment if
/// one misses the skin.
HandSections hand_sections(const geometry::TriangleMesh& skin, const Skeleton& skeleton,
                           const HandCreases& creases);

/// Where the line through `point` along `direction` leaves a curve on either side; `across` is
/// perpendicular to it in the plane of the curve. Coordinates along the line, mm; highest < lowest
/// if it misses the curve.
struct Chord {
  double lowest = 0.0, highest = -1.0;
};
Chord chord(const geometry::SectionCurve& curve, const Vec3& point, const Vec3& direction,
            const Vec3& across);

}  // namespace palmar::hand
