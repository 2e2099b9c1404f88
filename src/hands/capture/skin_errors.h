// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "hands/capture/skin_registration.h"
#include "palmar/hand/hand.h"

namespace palmar::capture {

/// Mean distance from some vertices of a hand's posed skin to the skin scanned in that posture
/// (hand frame), mm; spots, caps and places without skin within 15 mm left out. Nothing if none is
/// left.
std::optional<double> mean_skin_error(const hand::Hand& hand, const hand::Posture& posture,
                                      const std::vector<int>& vertices, const SkinScan& scan);

/// How well the contact areas of two skins on one product agree (Xie 2014, 2.4).
struct ContactOverlap {
  double hand_area = 0.0;                ///< of the posed hand's skin within the range, mm^2
  double scanned_area = 0.0;             ///< of the scanned skin, mm^2
  double shared_area = 0.0;              ///< of the product that both touch, mm^2
  double intersection_over_union = 0.0;  ///< on the product
  double share_of_hand = 0.0;            ///< of the product that the hand touches
  double share_of_scan = 0.0;            ///< of the product that the scanned skin touches
};

/// Contact is where skin comes within `range` [mm] of the product or into it. Areas of contact are
/// compared on the product: a point of its surface is touched by a skin that lies nearer than
/// `range`, or beyond it. All in one frame.
ContactOverlap contact_overlap(const geometry::TriangleMesh& posed_skin,
                               const geometry::TriangleMesh& scanned_skin,
                               const geometry::TriangleMesh& product, double range = 2.0);

}  // namespace palmar::capture
