// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "palmar/geometry/mesh/section.h"
#include "palmar/hand/hand.h"
#include "palmar/hand/skin/creases.h"

namespace palmar::hand {

/// What a tape measures along the skin, mm. A tape is taut: it follows what bulges and spans
/// hollows, so it is no shorter than the straight line, and the skin's roughness hardly counts.
struct SegmentTape {
  double girth = 0.0;  ///< round the segment half way; of the palm: hand circumference
  /// Between the ends of its length over the palmar skin, and over the back; nothing if the ends
  /// lie on different parts of the skin.
  std::optional<double> palmar_length, dorsal_length;
  /// Half way, from the middle of the radial side (between palmar and dorsal) to that of the ulnar
  /// one, over the palmar skin and over the back: about half the girth each.
  double palmar_width = 0.0, dorsal_width = 0.0;
};

struct HandTape {
  std::array<SegmentTape, kSegmentCount> segment;  ///< of the palm: width over the metacarpal heads
  /// Wrist crease to tip of the middle finger: palm and its three phalanges.
  std::optional<double> palmar_hand_length() const;
  std::optional<double> dorsal_hand_length() const;
};

/// Places a tape along the skin where measure_hand() measures straight: lengths in the plane
/// through both ends that holds the palmar direction half way, from crease to crease or to the
/// fingertip (dorsal ends: straight dorsal of the creases' centres); widths in the same sections as
/// those. Thickness has no tape. `creases`: as for measure_hand(). Throws InputError naming the
/// segment if a section misses the skin.
HandTape measure_with_tape(const geometry::TriangleMesh& skin, const Skeleton& skeleton,
                           const HandCreases& creases);

/// Length of a tape held taut over a closed curve, from its point nearest to `a` to that nearest to
/// `b`, on the side that unit vector `over` points to: upper convex hull of the curve's part there,
/// seen along the line a b. `over` lies in the plane of the curve. 0 for a curve of fewer than
/// three points, or if a and b are the same.
double taut_length(const geometry::SectionCurve& curve, const Vec3& a, const Vec3& b,
                   const Vec3& over);

/// A value with its name and, for those of segments, the segment: as in tables, in their order:
/// "hand_length_palmar", "length_dorsal", "girth" ...
struct TapeValue {
  std::string_view quantity;
  std::optional<Segment> segment;
  double value = 0.0;  ///< mm
};
std::vector<TapeValue> values_of(const HandTape& tape);

}  // namespace palmar::hand
