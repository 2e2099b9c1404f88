// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "hands/capture/scan/skin_marks.h"
#include "palmar/geometry/rigid3.h"
#include "palmar/hand/skeleton.h"

namespace palmar::capture {

/// A ring that was worn in a scan.
struct RingBand {
  hand::Segment segment{};  ///< phalanx it sits on
  double width = 0.0;       ///< along the finger, mm
  std::vector<int> vertex;  ///< of the scan
};

/// Rings among the patches of another colour than skin and ink (SkinMarks::other_colour): those
/// that go round a phalanx by five sixths of a turn or more, within 16 mm of its axis, and are 1.2
/// to 15 mm wide. `skeleton`: where joints lie, hand frame.
std::vector<RingBand> find_rings(const geometry::TriangleMesh& scan, const SkinMarks& marks,
                                 const geometry::Rigid3& hand_from_scan,
                                 const hand::Skeleton& skeleton);

/// The scan without its rings and what is within `margin` [mm] of them.
geometry::TriangleMesh without_rings(const geometry::TriangleMesh& scan,
                                     const std::vector<RingBand>& rings, double margin = 1.2);

}  // namespace palmar::capture
