// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/grasp/closing.h"
#include "palmar/grasp/grip_axis.h"

namespace palmar {

/// How a handle lies in a hand, as few numbers. The hand frame's z is palmar, y distal.
struct Lay {
  double turn = 0.0;      ///< of the product about the grip axis, rad (0: `wide` faces the palm)
  double oblique = 0.25;  ///< of the grip axis against the line of the metacarpal heads, its ulnar
                          ///< end towards the wrist, rad; people use 10-25 degrees
  double tilt = 0.05;     ///< radial end out of the palm, rad
  double proximal = 11;   ///< of the grip axis from the metacarpal heads towards the wrist, mm
  double along = 0.0;     ///< shift of the hand along the product's axis, mm
};

/// Product and hand before fingers close: the product pressed into the palm.
struct Placement {
  Lay lay;
  Rigid3 product_from_hand;
  Vec3 axis_in_hand = Vec3::UnitX();   ///< grip axis, unit
  Vec3 push_in_hand = -Vec3::UnitZ();  ///< unit direction in which the product meets the palm
};

/// Puts a grip site into the hand and pushes it into the palm until the palm or a finger's base
/// reaches its limit (HandCloser::free_travel). `product` gives the distance; its transform is not
/// used. With the fingers open.
Placement place(const HandCloser& closer, const DistanceField& product, const DepthLimits& limits,
                const GripSite& site, const Lay& lay);

/// One way of holding, closed without the thumb's final search.
struct Hold {
  std::size_t site = 0;
  Placement placement;
  Posture posture;
  HoldMeasure measure;
  double score = 0.0;  ///< mm^2 of palmar contact, plus credit for segments and wrap, minus clashes
};

/// Searches turns, then offsets and slants, for the hold that most palmar skin takes part in: what
/// distinguishes a power grip (Napier 1956). Coarse to fine, always in the same order. If `turn` is
/// set only that turn is used; with is_place_fixed the hand isn't shifted along the axis.
/// distances[k] is the product's distance as seen near sites[k]; sites beyond distances.size() are
/// not tried. Empty only for no sites.
std::optional<Hold> find_hold(const HandCloser& closer,
                              const std::vector<const DistanceField*>& distances,
                              const std::vector<GripSite>& sites, const DepthLimits& limits,
                              std::optional<double> turn, bool is_place_fixed,
                              const Progress& progress);

/// Limits that a product (its wall, if hollow) can take: skin must not come out on the other side,
/// nor meet skin from there.
DepthLimits limits_for(const DepthLimits& asked, const GripSite& site);

}  // namespace palmar
